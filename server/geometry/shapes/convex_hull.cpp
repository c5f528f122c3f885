// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/shapes/convex_hull.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace cohort::geometry {
namespace {

// A determinant of three differences is below 6 * (2^38)^3 = 2^117: it fits, so its sign is exact.
__extension__ using Exact = __int128;
constexpr int bits = 38;

using Index = std::uint32_t;
constexpr Index none = 0xffffffffu;

struct LatticePoint {
  std::int64_t x, y, z;
  friend LatticePoint operator-(const LatticePoint& a, const LatticePoint& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
};

struct ExactVector {
  Exact x, y, z;
};

// Avoids std::hypot, whose bits depend on the processor.
template <class Vector>
double squared_length(const Vector& v) {
  const auto x = static_cast<double>(v.x), y = static_cast<double>(v.y), z = static_cast<double>(v.z);
  return x * x + y * y + z * z;
}

ExactVector cross_product(const LatticePoint& a, const LatticePoint& b) {
  return {Exact(a.y) * b.z - Exact(a.z) * b.y, Exact(a.z) * b.x - Exact(a.x) * b.z,
          Exact(a.x) * b.y - Exact(a.y) * b.x};
}

struct Face {
  std::array<Index, 3> corners;     // counter-clockwise seen from outside
  std::array<Index, 3> neighbours;  // over the edge from this corner to the next
  std::vector<Index> outside;       // points that see this face and are assigned to it
  bool is_gone = false;
};

class Hull {
 public:
  explicit Hull(const std::vector<Eigen::Vector3d>& points) {
    round(points);
    start();
    // New faces are appended; a face without any outside points is finished.
    for (Index face = 0; face < faces_.size(); ++face)
      if (!faces_[face].is_gone && !faces_[face].outside.empty()) add_furthest(face);
  }

  std::vector<Face> faces() && {
    assert(is_closed());
    return std::move(faces_);
  }

 private:
  void round(const std::vector<Eigen::Vector3d>& points) {
    Eigen::Vector3d lower = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Vector3d upper = -lower;
    for (const Eigen::Vector3d& point : points) {
      lower = lower.cwiseMin(point);
      upper = upper.cwiseMax(point);
    }
    const double extent = points.empty() ? 0.0 : (upper - lower).maxCoeff();
    const double steps = std::ldexp(1.0, bits) / extent;
    if (!(extent > 0.0) || std::isinf(steps)) fail();
    points_.reserve(points.size());
    for (const Eigen::Vector3d& point : points) {
      const Eigen::Vector3d at = (point - lower) * steps;
      points_.push_back({std::llround(at.x()), std::llround(at.y()), std::llround(at.z())});
    }
  }

  [[noreturn]] static void fail() { throw std::invalid_argument("the points span no volume"); }

  // Returns six times the signed volume of the corners and the point: > 0 if the point is outside the plane through the
  // corners.
  Exact height(const std::array<Index, 3>& corners, Index point) const {
    const LatticePoint& a = points_[corners[0]];
    const ExactVector normal = cross_product(points_[corners[1]] - a, points_[corners[2]] - a);
    const LatticePoint to = points_[point] - a;
    return normal.x * to.x + normal.y * to.y + normal.z * to.z;
  }

  // Returns the point with the greatest `measure`, which must not be zero.
  template <class Measure>
  Index furthest(Measure&& measure) const {
    Index found = none;
    decltype(measure(Index{})) greatest = 0;
    for (Index i = 0; i < points_.size(); ++i)
      if (const auto its = measure(i); its > greatest) {
        greatest = its;
        found = i;
      }
    if (found == none) fail();
    return found;
  }

  // Chooses four points that span a volume. The measures need to be exact only for zero.
  void start() {
    const Index a = furthest([&](Index i) { return squared_length(points_[i] - points_[0]); });
    Index b = furthest([&](Index i) { return squared_length(points_[i] - points_[a]); });
    Index c = furthest(
        [&](Index i) { return squared_length(cross_product(points_[b] - points_[a], points_[i] - points_[a])); });
    const Index d = furthest([&](Index i) { return std::abs(static_cast<double>(height({a, b, c}, i))); });
    if (height({a, b, c}, d) > 0) std::swap(b, c);
    faces_ = {
        {{a, b, c}, {3, 2, 1}, {}}, {{a, c, d}, {0, 2, 3}, {}}, {{b, d, c}, {3, 1, 0}, {}}, {{a, d, b}, {1, 2, 0}, {}}};
    std::vector<Index> all(points_.size());
    std::iota(all.begin(), all.end(), Index{0});
    distribute(all, 0);
  }

  // Assigns each point to the first face, from `first` on, that it sees. A point that sees none is inside.
  void distribute(const std::vector<Index>& points, Index first) {
    for (const Index point : points)
      for (Index face = first; face < faces_.size(); ++face)
        if (height(faces_[face].corners, point) > 0) {
          faces_[face].outside.push_back(point);
          break;
        }
  }

  void add_furthest(Index seen) {
    const std::vector<Index>& waiting = faces_[seen].outside;
    const Index point = *std::max_element(waiting.begin(), waiting.end(), [&](Index i, Index j) {
      return height(faces_[seen].corners, i) < height(faces_[seen].corners, j);
    });
    const std::vector<Index> visible = remove_visible(seen, point);
    const auto first_new = static_cast<Index>(faces_.size());
    close_gap(visible, point);
    std::vector<Index> homeless;
    for (const Index face : visible) {
      homeless.insert(homeless.end(), faces_[face].outside.begin(), faces_[face].outside.end());
      faces_[face].outside = {};
    }
    distribute(homeless, first_new);
  }

  // Removes and returns all faces that the point sees; they are connected.
  std::vector<Index> remove_visible(Index seen, Index point) {
    std::vector<Index> visible{seen};
    faces_[seen].is_gone = true;
    for (std::size_t i = 0; i < visible.size(); ++i)
      for (const Index neighbour : faces_[visible[i]].neighbours)
        if (!faces_[neighbour].is_gone && height(faces_[neighbour].corners, point) > 0) {
          faces_[neighbour].is_gone = true;
          visible.push_back(neighbour);
        }
    return visible;
  }

  // Adds a face from the point to each edge of the gap, in order around it.
  void close_gap(const std::vector<Index>& visible, Index point) {
    const auto first_new = static_cast<Index>(faces_.size());
    for (const Index face : visible)
      for (int edge = 0; edge < 3; ++edge) {
        const Index beyond = faces_[face].neighbours[edge];
        if (faces_[beyond].is_gone) continue;
        const Index from = faces_[face].corners[edge];
        const Index to = faces_[face].corners[(edge + 1) % 3];
        const auto made = static_cast<Index>(faces_.size());
        std::replace(faces_[beyond].neighbours.begin(), faces_[beyond].neighbours.end(), face, made);
        faces_.push_back({{from, to, point}, {beyond, none, none}, {}});
      }
    face_from_.resize(points_.size(), none);
    for (Index made = first_new; made < faces_.size(); ++made) face_from_[faces_[made].corners[0]] = made;
    for (Index made = first_new; made < faces_.size(); ++made) {
      const Index next = face_from_[faces_[made].corners[1]];
      faces_[made].neighbours[1] = next;
      faces_[next].neighbours[2] = made;
    }
  }

  // Returns whether each edge joins two faces that know each other.
  bool is_closed() const {
    for (Index face = 0; face < faces_.size(); ++face)
      for (const Index neighbour : faces_[face].neighbours)
        if (!faces_[face].is_gone &&
            (faces_[neighbour].is_gone ||
             std::ranges::find(faces_[neighbour].neighbours, face) == faces_[neighbour].neighbours.end()))
          return false;
    return true;
  }

  std::vector<LatticePoint> points_;
  std::vector<Face> faces_;
  std::vector<Index> face_from_;  // by point: the new face whose edge of the gap starts there
};

}  // namespace

description::TriangleMesh convex_hull(const std::vector<Eigen::Vector3d>& points) {
  const std::vector<Face> faces = Hull(points).faces();
  std::vector<Index> place(points.size(), none);
  for (const Face& face : faces)
    if (!face.is_gone)
      for (const Index corner : face.corners) place[corner] = 0;
  description::TriangleMesh hull;
  for (Index i = 0; i < points.size(); ++i) {
    if (place[i] == none) continue;
    place[i] = static_cast<Index>(hull.vertices.size());
    hull.vertices.push_back(points[i]);
  }
  for (const Face& face : faces)
    if (!face.is_gone)
      hull.triangles.push_back({place[face.corners[0]], place[face.corners[1]], place[face.corners[2]]});
  return hull;
}

}  // namespace cohort::geometry
