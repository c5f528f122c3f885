// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

/// Parts of an SVG drawing. Points are in units of the page: x to the right, y downwards. The functions are pure: equal
/// arguments give equal text.
namespace cohort::tool::svg {

using Points = std::vector<Eigen::Vector2d>;

/// Returns a number with at most two decimals.
std::string number(double value);

/// Escapes text for use between tags and in attributes.
std::string escaped(std::string_view text);

/// Returns the `d` attribute of an open path through `points`, rounded to a tenth of a unit.
std::string path_data(const Points& points);

/// Returns the `points` attribute of a polygon.
std::string polygon_points(const Points& points);

/// Returns a subset of `points`, including both ends, from which no point is farther than `tolerance`. (Douglas and
/// Peucker, "Algorithms for the reduction of the number of points required to represent a digitized line or its
/// caricature", Cartographica 10(2), 1973).
Points simplified(const Points& points, double tolerance);

/// Returns `#rrggbb` of a colour in OKLCH, with its chroma reduced as far as sRGB requires. The hue is in turns (B.
/// Ottosson, "A perceptual color space for image processing", 2020).
std::string oklch(double lightness, double chroma, double hue);

/// Returns a colour for item `index` of `count`: hues around the colour circle, alternately light and dark. `shade` is
/// added to the lightness.
std::string colour_of(std::size_t index, std::size_t count, double shade = 0.0);

}  // namespace cohort::tool::svg
