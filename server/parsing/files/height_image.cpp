// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/files/height_image.hpp"

#include <png.h>

#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace cohort::parsing {
namespace {

constexpr png_uint_32 most_pixels = 8193;  // along an edge

struct PngImage {
  std::string_view unread;  // rest of the file
  png_uint_32 width = 0;
  png_uint_32 height = 0;
  int bits = 0;
  int colours = 0;
  std::vector<png_byte> bytes;  // row by row; of 16 bits, the higher byte first
  std::vector<png_bytep> rows;  // start of each in `bytes`
  std::string error;
};

// libpng leaves its calls by longjmp, so these functions must have no objects with destructors.
extern "C" void keep_error(png_structp png, png_const_charp message) {
  static_cast<PngImage*>(png_get_error_ptr(png))->error = message;
  png_longjmp(png, 1);
}
extern "C" void ignore_warning(png_structp, png_const_charp) {}
extern "C" void take_bytes(png_structp png, png_bytep bytes, std::size_t count) {
  std::string_view& unread = static_cast<PngImage*>(png_get_io_ptr(png))->unread;
  if (count > unread.size()) png_error(png, "the file is truncated");
  std::memcpy(bytes, unread.data(), count);
  unread.remove_prefix(count);
}

// Returns false if libpng fails; `image` then has its message.
bool read_header(png_structp png, png_infop info, PngImage& image) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_user_limits(png, most_pixels, most_pixels);
  png_set_read_fn(png, &image, &take_bytes);
  png_read_info(png, info);
  image.width = png_get_image_width(png, info);
  image.height = png_get_image_height(png, info);
  image.bits = png_get_bit_depth(png, info);
  image.colours = png_get_color_type(png, info);
  return true;
}

bool read_pixels(png_structp png, PngImage& image) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_image(png, image.rows.data());
  png_read_end(png, nullptr);
  return true;
}

PngImage read_png(InputFiles& input, const std::filesystem::path& path) {
  const auto fail = [&](const std::string& why) -> void {
    throw std::runtime_error("'" + path.string() + "' cannot be read as a height map: " + why);
  };
  if (const auto reason = input.why_unreadable(path)) fail(*reason);
  PngImage image;
  image.unread = input.read(path);
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &image, &keep_error, &ignore_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  const auto destroy = [&info](png_structp made) { png_destroy_read_struct(&made, &info, nullptr); };
  const std::unique_ptr<png_struct, decltype(destroy)> owner(png, destroy);
  if (info == nullptr) fail("not enough memory");

  if (!read_header(png, info, image)) fail(image.error + "; expected a PNG image");
  if (image.colours != PNG_COLOR_TYPE_GRAY || image.bits < 8)
    fail("expected a greyscale PNG image with 8 or 16 bits per pixel and without transparency");
  if (image.width < 2 || image.height < 2) fail("expected at least 2 by 2 pixels");
  const std::size_t row_bytes = png_get_rowbytes(png, info);
  image.bytes.resize(image.height * row_bytes);
  for (std::size_t row = 0; row < image.height; ++row) image.rows.push_back(image.bytes.data() + row * row_bytes);
  if (!read_pixels(png, image)) fail(image.error);
  return image;
}

}  // namespace

HeightGrid read_height_image(InputFiles& input, const std::filesystem::path& file, const Eigen::Vector3d& size) {
  const PngImage image = read_png(input, file);
  HeightGrid grid;
  grid.columns = image.width;
  grid.rows = image.height;
  grid.spacing = {size.x() / (image.width - 1), size.y() / (image.height - 1)};
  grid.heights.reserve(grid.columns * grid.rows);
  const bool is_wide = image.bits == 16;
  const double white = is_wide ? 65535.0 : 255.0;
  for (std::size_t row = grid.rows; row-- > 0;)  // the image begins at its upper edge
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const png_byte* const pixel = image.rows[row] + column * (is_wide ? 2 : 1);
      const int grey = is_wide ? pixel[0] * 256 + pixel[1] : pixel[0];
      grid.heights.push_back(size.z() * grey / white);
    }
  return grid;
}

}  // namespace cohort::parsing
