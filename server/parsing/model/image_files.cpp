// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/model/image_files.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

namespace cohort::parsing {

namespace fs = std::filesystem;

ImageFiles::ImagePtr ImageFiles::image_of_mesh(std::string name, const fs::path& mesh) {
  std::ranges::replace(name, '\\', '/');
  const fs::path folder = mesh.parent_path();
  if (name.find("://") == std::string::npos && !files_.input().is_file(folder / name))
    for (const char* const other : {"../materials/textures", "."})
      if (fs::path moved = folder / other / fs::path(name).filename(); files_.input().is_file(moved))
        return read(moved.lexically_normal());
  return read(files_.find_file(name, folder));
}

ImageFiles::ImagePtr ImageFiles::embedded_image(std::string bytes) {
  if (const auto known = by_content_.find(bytes); known != by_content_.end()) return known->second;
  const description::ImageSize size = description::checked_image_size(bytes);
  if (const std::optional<std::string> limit = budget_.add(bytes.size(), size)) throw std::runtime_error(*limit);
  auto image = std::make_shared<const description::Image>(description::Image{std::move(bytes), size});
  by_content_.emplace(image->bytes, image);
  return image;
}

ImageFiles::ImagePtr ImageFiles::read(const fs::path& file) {
  ImagePtr& image = by_file_[file];
  if (image) return image;
  try {
    if (const auto reason = files_.input().why_unreadable(file)) throw std::runtime_error(*reason);
    if (files_.input().size(file) > description::most_image_bytes)
      throw std::runtime_error("the image is larger than " + std::to_string(description::most_image_bytes >> 20) +
                               " MiB");
    image = embedded_image(files_.input().read(file));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(std::string(error.what()) + ": '" + file.string() + "'");
  }
  return image;
}

}  // namespace cohort::parsing
