// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "server/description/texture_image.hpp"
#include "server/parsing/sdf/sdf_files.hpp"

namespace cohort::parsing {

/// The images of a world, found like its meshes. Equal images are one object, also if their files differ. The functions
/// throw std::runtime_error with the reason if an image cannot be shown.
class ImageFiles {
 public:
  using ImagePtr = std::shared_ptr<const description::Image>;

  /// `files` must outlive this.
  explicit ImageFiles(const SdfFiles& files) : files_(files) {}

  /// Returns the image that the URI in `element` names.
  ImagePtr image(const Element* element) { return read(files_.find_file(element)); }

  /// Returns the image that the file of a mesh names. A path is relative to this file. As in Gazebo, an image that is
  /// not there may be in `../materials/textures`; one whose folder does not exist may be beside the mesh.
  ImagePtr image_of_mesh(std::string name, const std::filesystem::path& mesh);

  /// Returns an image that is embedded in another file.
  ImagePtr embedded_image(std::string bytes);

 private:
  ImagePtr read(const std::filesystem::path& file);

  const SdfFiles& files_;
  description::ImageBudget budget_;
  std::map<std::filesystem::path, ImagePtr> by_file_;
  std::map<std::string_view, ImagePtr> by_content_;  // the keys are in the images
};

}  // namespace cohort::parsing
