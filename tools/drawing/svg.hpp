#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

/// What a drawing in SVG is made of. Points are in the units of the page: x to the right, y downwards. Pure functions;
/// the same arguments give the same text.
namespace cohort::tool::svg {

using Points = std::vector<Eigen::Vector2d>;

/// With two decimals at the most.
std::string number(double value);

/// For use between tags and in attributes.
std::string escaped(std::string_view text);

/// The `d` attribute of an open path through `points`, to a tenth of a unit.
std::string path_data(const Points& points);

/// The `points` attribute of a polygon.
std::string polygon_points(const Points& points);

/// A part of `points` that stays within `tolerance` of all of them, both ends included (Douglas and Peucker,
/// "Algorithms for the reduction of the number of points required to represent a digitized line or its caricature",
/// Cartographica 10(2), 1973).
Points simplified(const Points& points, double tolerance);

/// `#rrggbb` of a colour in OKLCH, its chroma lowered as far as sRGB requires. Hue in turns (B. Ottosson, "A perceptual
/// color space for image processing", 2020).
std::string oklch(double lightness, double chroma, double hue);

}  // namespace cohort::tool::svg
