// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/files/mesh_import.hpp"

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace cohort::parsing {
namespace {

Eigen::Matrix4d matrix_of(const aiMatrix4x4& m) {
  Eigen::Matrix4d matrix;
  matrix << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
  return matrix;
}

// A file for assimp: the mesh or a file that it names, such as the .mtl of an .obj.
class AssimpStream : public Assimp::IOStream {
 public:
  explicit AssimpStream(const std::string& bytes) : bytes_(bytes) {}

  std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    const std::size_t whole = std::min(count, (bytes_.size() - at_) / size);
    std::memcpy(buffer, bytes_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
    const std::size_t to = from + offset;  // backwards, it wraps around
    if (to > bytes_.size()) return aiReturn_FAILURE;
    at_ = to;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

class AssimpFiles : public Assimp::IOSystem {
 public:
  explicit AssimpFiles(MeshSources& sources) : sources_(sources) {}

  bool Exists(const char* file) const override { return sources_.is_file(file); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (std::string_view(mode).find_first_of("wa+") != std::string_view::npos) return nullptr;
    const std::string* const bytes = sources_.read(file);
    return bytes == nullptr ? nullptr : new AssimpStream(*bytes);
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  MeshSources& sources_;
};

using Color = std::array<std::uint8_t, 3>;

std::uint8_t byte_of(float part) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(static_cast<double>(part), 0.0, 1.0)));
}

// Returns a linear part of a colour as sRGB (IEC 61966-2-1).
float encoded(float linear) {
  constexpr float end_of_line = 0.0031308f;
  if (linear <= end_of_line) return 12.92f * linear;
  return 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

// Returns the material colour of a part; nothing if the file has none. (assimp adds a material to such a part.)
std::optional<Color> color_of(const aiScene& scene, const aiMesh& part, bool is_linear) {
  if (part.mMaterialIndex >= scene.mNumMaterials) return std::nullopt;
  const aiMaterial& material = *scene.mMaterials[part.mMaterialIndex];
  aiString name;
  if (material.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS && name == aiString(AI_DEFAULT_MATERIAL_NAME))
    return std::nullopt;
  aiColor3D color;
  if (material.Get(AI_MATKEY_COLOR_DIFFUSE, color) != aiReturn_SUCCESS) return std::nullopt;
  if (is_linear) color = {encoded(color.r), encoded(color.g), encoded(color.b)};
  return Color{byte_of(color.r), byte_of(color.g), byte_of(color.b)};
}

struct TextureOfPart {
  std::uint32_t image = MeshTextures::none;
  unsigned channel = 0;  // index of its texture coordinates
};

bool has_coordinates(const aiMesh& part, unsigned channel) {
  return channel < AI_MAX_NUMBER_OF_TEXTURECOORDS && part.mTextureCoords[channel] != nullptr;
}

// The images that the materials of a file name.
class Images {
 public:
  explicit Images(const aiScene& scene) : scene_(scene) {}

  TextureOfPart texture_of(const aiMesh& part) {
    if (part.mMaterialIndex >= scene_.mNumMaterials) return {};
    aiString name;
    TextureOfPart texture;
    if (scene_.mMaterials[part.mMaterialIndex]->GetTexture(aiTextureType_DIFFUSE, 0, &name, nullptr,
                                                           &texture.channel) != aiReturn_SUCCESS ||
        name.length == 0)
      return {};
    if (!has_coordinates(part, texture.channel)) texture.channel = 0;
    if (has_coordinates(part, texture.channel)) texture.image = index_of(name);
    return texture;
  }

  std::vector<MeshImage> take() { return std::move(images_); }

 private:
  std::uint32_t index_of(const aiString& name) {
    const auto [entry, is_new] = indices_.emplace(name.C_Str(), static_cast<std::uint32_t>(images_.size()));
    if (!is_new) return entry->second;
    const aiTexture* const embedded = scene_.GetEmbeddedTexture(name.C_Str());
    images_.push_back(embedded == nullptr ? MeshImage{name.C_Str(), {}} : MeshImage{{}, content_of(*embedded)});
    return entry->second;
  }

  // A texture without a height is a file. Others are pixels, which no supported format has.
  static std::string content_of(const aiTexture& texture) {
    if (texture.mHeight != 0 || texture.pcData == nullptr || texture.mWidth > most_image_bytes) return {};
    return {reinterpret_cast<const char*>(texture.pcData), texture.mWidth};
  }

  const aiScene& scene_;
  std::vector<MeshImage> images_;
  std::map<std::string, std::uint32_t> indices_;
};

// Equal for 0 and -0, which are equal.
struct HashOfPlace {
  std::size_t operator()(const std::array<double, 3>& place) const {
    constexpr std::uint64_t odd = 0x9e3779b97f4a7c15;  // 2^64 / golden ratio
    std::uint64_t hash = 0;
    for (const double part : place) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(part + 0.0)) * odd;
      hash ^= hash >> 32U;
    }
    return hash;
  }
};

// Adds triangles to a mesh and merges equal vertices, which formats such as STL repeat for each triangle.
class MeshBuilder {
 public:
  void add(const aiMesh& part, const Eigen::Matrix4d& transform, const std::optional<Color>& color,
           const TextureOfPart& texture) {
    has_textures_ = has_textures_ || texture.image != MeshTextures::none;
    has_colors_ = has_colors_ || has_textures_ || color;
    has_coordinates_ = has_coordinates_ || has_coordinates(part, texture.channel);
    std::vector<std::uint32_t> places(part.mNumVertices);
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D& v = part.mVertices[i];
      places[i] = place_of((transform * Eigen::Vector4d(v.x, v.y, v.z, 1.0)).head<3>());
    }
    const bool mirrors = transform.topLeftCorner<3, 3>().determinant() < 0.0;
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      if (face.mNumIndices != 3) continue;  // a point or a line
      std::array<std::uint32_t, 3> triangle{};
      std::array<std::array<float, 2>, 3> coordinates{};
      for (unsigned corner = 0; corner < 3; ++corner) {
        if (face.mIndices[corner] >= part.mNumVertices)
          throw std::runtime_error("a triangle refers to a vertex that does not exist");
        triangle[corner] = places[face.mIndices[corner]];
        coordinates[corner] = coordinates_of(part, texture.channel, face.mIndices[corner]);
      }
      if (mirrors) {
        std::swap(triangle[1], triangle[2]);
        std::swap(coordinates[1], coordinates[2]);
      }
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
      mesh_.triangles.push_back(triangle);
      mesh_.colors.push_back(color.value_or(plain));
      mesh_.textures.coordinates.push_back(coordinates);
      mesh_.textures.of_triangles.push_back(texture.image);
    }
  }

  TriangleMesh take() {
    if (!has_colors_) mesh_.colors.clear();
    if (!has_coordinates_) mesh_.textures.coordinates.clear();
    if (!has_textures_) mesh_.textures.of_triangles.clear();
    return std::move(mesh_);
  }

 private:
  static std::array<float, 2> coordinates_of(const aiMesh& part, unsigned channel, unsigned vertex) {
    if (!has_coordinates(part, channel)) return {};
    const aiVector3D& place = part.mTextureCoords[channel][vertex];
    return std::isfinite(place.x) && std::isfinite(place.y) ? std::array{place.x, place.y} : std::array<float, 2>{};
  }
  std::uint32_t place_of(const Eigen::Vector3d& vertex) {
    if (!vertex.allFinite()) throw std::runtime_error("a vertex is not finite");
    const auto next = static_cast<std::uint32_t>(mesh_.vertices.size());
    const auto [entry, is_new] = places_.try_emplace(std::array{vertex.x(), vertex.y(), vertex.z()}, next);
    if (is_new) mesh_.vertices.push_back(vertex);
    return entry->second;
  }

  static constexpr Color plain{128, 128, 128};

  TriangleMesh mesh_;
  bool has_colors_ = false;
  bool has_coordinates_ = false;
  bool has_textures_ = false;
  std::unordered_map<std::array<double, 3>, std::uint32_t, HashOfPlace> places_;
};

// Colours in glTF files are linear.
bool is_gltf_file(const std::filesystem::path& file) {
  const std::string extension = file.extension();
  return extension.size() > 2 && std::tolower(static_cast<unsigned char>(extension[1])) == 'g';
}

// Selects the parts of a submesh, and notes the names of all. As in Gazebo, the name is that of a node; parts that
// formats do not put into nodes of their own have names too.
class Selection {
 public:
  explicit Selection(const std::string& submesh) : submesh_(submesh) {}

  bool contains(const aiNode& node, const aiMesh& part) {
    if (submesh_.empty()) return true;
    for (const aiString* const name : {&node.mName, &part.mName})
      if (name->length > 0) names_.insert(name->C_Str());
    return submesh_ == node.mName.C_Str() || submesh_ == part.mName.C_Str();
  }
  void expect_found(const std::filesystem::path& file) const {
    if (submesh_.empty() || names_.contains(submesh_)) return;
    std::string all;
    for (const std::string& name : names_) all += (all.empty() ? "'" : ", '") + name + "'";
    throw std::runtime_error("'" + file.string() + "' has no submesh '" + submesh_ + "'; " +
                             (all.empty() ? "its parts have no names" : "expected one of " + all));
  }

 private:
  const std::string& submesh_;
  std::set<std::string> names_;
};

// Returns the text of a COLLADA file without its effects, that is, without colours and textures. It is empty for other
// files, and for files without effects. assimp reads no mesh of a file in which a texture has no image.
std::string without_effects(MeshSources& sources, const std::filesystem::path& file) {
  constexpr std::string_view begin_tag = "<library_effects";
  constexpr std::string_view end_tag = "</library_effects>";
  const std::string* const text = sources.read(file.string());
  if (text == nullptr || text->find("<COLLADA") == std::string::npos) return "";
  const std::size_t begin = text->find(begin_tag);
  const std::size_t end = begin != std::string::npos ? text->find(end_tag, begin) : std::string::npos;
  return end != std::string::npos ? text->substr(0, begin) + text->substr(end + end_tag.size()) : "";
}

// Moves the centre of the bounding box to the origin.
void centre(std::vector<Eigen::Vector3d>& vertices) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : vertices) box.extend(vertex);
  const Eigen::Vector3d middle = box.center();
  for (Eigen::Vector3d& vertex : vertices) vertex -= middle;
}

}  // namespace

ImportedMesh import_mesh(MeshSources& sources, const std::filesystem::path& file, const Eigen::Vector3d& scale,
                         const MeshPart& which) {
  Assimp::Importer importer;
  importer.SetIOHandler(new AssimpFiles(sources));  // which it owns
  // Otherwise assimp would rotate a file whose z axis points upwards.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate);
  const std::string problem = importer.GetErrorString();
  const std::string plain = scene == nullptr ? without_effects(sources, file) : "";
  if (!plain.empty()) scene = importer.ReadFileFromMemory(plain.data(), plain.size(), aiProcess_Triangulate, "dae");
  if (scene == nullptr || scene->mRootNode == nullptr)
    throw std::runtime_error("'" + file.string() + "' cannot be read: " + problem);

  const bool is_gltf = is_gltf_file(file);
  MeshBuilder builder;
  Images images(*scene);
  Selection selection(which.submesh);
  struct Placed {
    const aiNode* node;
    Eigen::Matrix4d transform;
  };
  Eigen::Matrix4d scaling = Eigen::Matrix4d::Identity();
  scaling.diagonal().head<3>() = scale;
  std::vector<Placed> waiting{{scene->mRootNode, scaling}};
  try {
    while (!waiting.empty()) {
      const auto [node, parent] = waiting.back();
      waiting.pop_back();
      const Eigen::Matrix4d transform = parent * matrix_of(node->mTransformation);
      for (unsigned i = 0; i < node->mNumMeshes; ++i) {
        const aiMesh& part = *scene->mMeshes[node->mMeshes[i]];
        if (!selection.contains(*node, part)) continue;
        builder.add(part, transform, color_of(*scene, part, is_gltf), images.texture_of(part));
      }
      for (unsigned i = node->mNumChildren; i-- > 0;) waiting.push_back({node->mChildren[i], transform});
    }
  } catch (const std::runtime_error& error) {
    throw std::runtime_error("'" + file.string() + "' is invalid: " + error.what());
  }
  selection.expect_found(file);
  ImportedMesh mesh{builder.take(), images.take()};
  if (which.is_centered) centre(mesh.vertices);
  if (mesh.triangles.empty()) throw std::runtime_error("'" + file.string() + "' has no triangles");
  return mesh;
}

}  // namespace cohort::parsing
