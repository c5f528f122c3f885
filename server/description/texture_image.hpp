// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace cohort::description {

/// The size of an image [px].
struct ImageSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

/// An image that is shown on surfaces; sensors do not see it. The server does not decode it.
struct Image {
  std::string bytes;  ///< content of a PNG or JPEG file
  ImageSize size;
};

/// Limits of one image.
inline constexpr std::size_t most_image_bytes = std::size_t{8} << 20;
inline constexpr std::uint32_t most_image_pixels = 8192;  ///< along an edge

/// Returns the size in the header of a PNG or JPEG file. Throws std::runtime_error with the reason if `bytes` are
/// neither, or exceed a limit of one image.
ImageSize checked_image_size(std::string_view bytes);

/// Counts the different images of a world.
class ImageBudget {
 public:
  static constexpr std::size_t most_images = 64;
  static constexpr std::size_t most_bytes = std::size_t{32} << 20;
  static constexpr std::uint64_t most_pixels = std::uint64_t{1} << 26;

  /// Counts an image. If it would exceed a limit of a world, returns the limit, and does not count the image.
  std::optional<std::string> add(std::size_t bytes, ImageSize size);

 private:
  std::size_t images_ = 0;
  std::size_t bytes_ = 0;
  std::uint64_t pixels_ = 0;
};

}  // namespace cohort::description
