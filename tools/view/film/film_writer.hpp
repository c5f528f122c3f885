// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

namespace cohort::film {

/// Writes the pictures of a film to a file, or to numbered files.
class FilmWriter {
 public:
  virtual ~FilmWriter() = default;
  /// Adds a picture (PNG). Throws std::runtime_error.
  virtual void add(std::string_view picture) = 0;
  /// Completes the film and gives the file its name. Without this call, the film is discarded. Throws
  /// std::runtime_error.
  virtual void finish() = 0;
  /// Returns whether only one picture can be added.
  virtual bool is_single() const { return false; }
};

struct FilmSize {
  std::uint32_t width = 1280;  ///< [pixels]
  std::uint32_t height = 720;
};

/// Returns whether a file name is that of numbered pictures, such as frame_%04d.png.
bool has_numbers(const std::filesystem::path& file);

/// Returns the writer for a file name that ends in .mp4, .webm, .gif, .webp or .png. A name of a PNG with one `%d` or,
/// for example, `%04d` means numbered pictures, from 0. ffmpeg writes the films. Throws std::invalid_argument for other
/// names and for sizes that the format does not support. Throws std::runtime_error if ffmpeg is missing or the file
/// cannot be written. `stop` must outlive the writer.
std::unique_ptr<FilmWriter> make_film_writer(const std::filesystem::path& file, FilmSize size, unsigned fps,
                                             const std::atomic<bool>& stop);

}  // namespace cohort::film
