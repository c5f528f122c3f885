#pragma once

#include <filesystem>
#include <optional>
#include <sdf/ParserConfig.hh>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// A URDF <robot> as the <sdf> element that libsdformat makes of it, each element with the line of the URDF element
/// that it comes from. What is wrong goes to `problems`, with its line, and there is nothing then; what is left out
/// goes to `warnings`.
std::optional<XmlNode> sdf_of_urdf(XmlNode robot, const std::filesystem::path& file, const sdf::ParserConfig& config,
                                   std::vector<Problem>& problems, std::vector<Problem>& warnings);

/// Checks a URDF <robot> against the format, as far as its converter would be silent or stop: names, references,
/// numbers, and that the links are one tree.
void check_urdf(const XmlNode& robot, const std::filesystem::path& file, std::vector<Problem>& problems,
                std::vector<Problem>& warnings);

}  // namespace cohort::parsing
