// SPDX-License-Identifier: Apache-2.0
#include "server/description/texture_image.hpp"

#include <stdexcept>

namespace cohort::description {
namespace {

constexpr const char* neither = "expected a PNG or JPEG image";

std::uint32_t byte_at(std::string_view bytes, std::size_t at) {
  if (at >= bytes.size()) throw std::runtime_error("the image is truncated");
  return static_cast<unsigned char>(bytes[at]);
}

// Returns a big-endian number.
std::uint32_t number_at(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < size; ++i) number = number << 8 | byte_at(bytes, at + i);
  return number;
}

// PNG specification, 3rd edition, 5.2 and 11.2.1: the first chunk is IHDR, of 13 bytes.
ImageSize size_of_png(std::string_view bytes) {
  constexpr std::size_t length_of_header = 13;
  if (number_at(bytes, 8, 4) != length_of_header || bytes.substr(12, 4) != "IHDR") throw std::runtime_error(neither);
  return {number_at(bytes, 16, 4), number_at(bytes, 20, 4)};
}

bool begins_frame(std::uint32_t marker) {
  constexpr std::uint32_t first = 0xc0, last = 0xcf, huffman_tables = 0xc4, extension = 0xc8, arithmetic = 0xcc;
  return marker >= first && marker <= last && marker != huffman_tables && marker != extension && marker != arithmetic;
}

// ITU-T T.81, B.1.1 and B.2.2: segments, up to the header of the frame.
ImageSize size_of_jpeg(std::string_view bytes) {
  constexpr std::uint32_t begin = 0xff, begin_of_scan = 0xda, end_of_image = 0xd9;
  std::size_t at = 2;
  while (true) {
    if (byte_at(bytes, at) != begin) throw std::runtime_error(neither);
    while (byte_at(bytes, at) == begin) ++at;  // fill bytes
    const std::uint32_t marker = byte_at(bytes, at++);
    if (marker == begin_of_scan || marker == end_of_image) throw std::runtime_error(neither);
    if (begins_frame(marker)) return {number_at(bytes, at + 5, 2), number_at(bytes, at + 3, 2)};
    const std::uint32_t length = number_at(bytes, at, 2);
    if (length < 2) throw std::runtime_error(neither);
    at += length;
  }
}

std::string mebibytes(std::size_t bytes) { return std::to_string(bytes >> 20) + " MiB"; }

}  // namespace

ImageSize checked_image_size(std::string_view bytes) {
  if (bytes.size() > most_image_bytes)
    throw std::runtime_error("the image is larger than " + mebibytes(most_image_bytes));
  const bool is_png = bytes.starts_with("\x89PNG\r\n\x1a\n");
  if (!is_png && !bytes.starts_with("\xff\xd8\xff")) throw std::runtime_error(neither);
  const ImageSize size = is_png ? size_of_png(bytes) : size_of_jpeg(bytes);
  if (size.width == 0 || size.height == 0) throw std::runtime_error("the image has no pixels");
  if (size.width > most_image_pixels || size.height > most_image_pixels)
    throw std::runtime_error("the image has " + std::to_string(size.width) + " by " + std::to_string(size.height) +
                             " pixels; expected at most " + std::to_string(most_image_pixels) + " along an edge");
  return size;
}

std::optional<std::string> ImageBudget::add(std::size_t bytes, ImageSize size) {
  const std::uint64_t pixels = std::uint64_t{size.width} * size.height;
  if (images_ + 1 > most_images) return "a world has at most " + std::to_string(most_images) + " images";
  if (bytes_ + bytes > most_bytes) return "the images of a world have at most " + mebibytes(most_bytes);
  if (pixels_ + pixels > most_pixels)
    return "the images of a world have at most " + std::to_string(most_pixels) + " pixels";
  ++images_;
  bytes_ += bytes;
  pixels_ += pixels;
  return std::nullopt;
}

}  // namespace cohort::description
