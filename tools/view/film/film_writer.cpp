// SPDX-License-Identifier: Apache-2.0
#include "tools/view/film/film_writer.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "server/core/atomic_file.hpp"
#include "tools/common/processes/connected_program.hpp"

namespace cohort::film {
namespace {

using tool::ConnectedProgram;
using Words = std::vector<std::string>;

constexpr const char* name_of_film = "the film";

// Colours as televisions and browsers expect them.
const Words bt709 = {"-vf",
                     "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
                     "-colorspace",
                     "bt709",
                     "-color_primaries",
                     "bt709",
                     "-color_trc",
                     "bt709"};

struct Format {
  const char* extension;
  Words options;
  bool needs_even_size = false;
};
const std::vector<Format>& formats() {
  static const std::vector<Format> all = {
      {".mp4", {"-c:v", "libx264", "-preset", "medium", "-crf", "18", "-movflags", "+faststart", "-f", "mp4"}, true},
      {".webm",
       {"-c:v", "libvpx-vp9", "-crf", "30", "-b:v", "0", "-deadline", "good", "-cpu-used", "4", "-row-mt", "1", "-f",
        "webm"},
       true},
      {".webp", {"-c:v", "libwebp_anim", "-quality", "75", "-compression_level", "4", "-loop", "0", "-f", "webp"}},
      {".gif", {"-loop", "0", "-f", "gif"}},
  };
  return all;
}

std::filesystem::path ffmpeg() {
  if (auto found = tool::find_program("ffmpeg")) return *found;
  throw std::runtime_error(
      "the program ffmpeg, which writes films, is missing: install the Debian package ffmpeg, or "
      "write pictures ('-o frame_%04d.png')");
}

template <class... Parts>
Words joined(const Parts&... parts) {
  Words all;
  (all.insert(all.end(), parts.begin(), parts.end()), ...);
  return all;
}

// `-bitexact`: the same pictures give the same file.
const Words quietly = {"-hide_banner", "-loglevel", "error", "-y"};
const Words repeatably = {"-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact"};
std::string url_of(const std::filesystem::path& file) { return "file:" + file.string(); }

void expect_success(ConnectedProgram& program) {
  if (program.finish() == 0) return;
  std::string printed = program.printed();
  while (!printed.empty() && printed.back() == '\n') printed.pop_back();
  const std::size_t line = printed.rfind('\n');
  if (line != std::string::npos) printed.erase(0, line + 1);
  throw WriteError(fmt::format("the film cannot be written: ffmpeg reports {}", printed));
}

Words read_pictures(unsigned fps) {
  return {"-f", "image2pipe", "-c:v", "png", "-framerate", std::to_string(fps), "-i", "pipe:0"};
}

// A film that ffmpeg writes while pictures come.
class EncodedFilm final : public FilmWriter {
 public:
  EncodedFilm(const std::filesystem::path& file, const Format& format, unsigned fps, const std::atomic<bool>& stop)
      : file_(name_of_film, file),
        encoder_(joined(Words{ffmpeg()}, quietly, read_pictures(fps), format.needs_even_size ? bt709 : Words{},
                        format.options, repeatably, Words{url_of(file_.path())}),
                 {STDIN_FILENO}, stop) {}

  void add(std::string_view picture) override { encoder_.send(picture); }
  void finish() override {
    expect_success(encoder_);
    file_.commit();
  }

 private:
  AtomicFile file_;  // outlives the encoder
  ConnectedProgram encoder_;
};

class TemporaryFile {
 public:
  explicit TemporaryFile(std::filesystem::path file) : path(std::move(file)) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
  const std::filesystem::path path;
};

// A GIF has 256 colours, which depend on all pictures. So the pictures are kept in a lossless film beside it first,
// which bounds the memory.
class GifFilm final : public FilmWriter {
 public:
  GifFilm(const std::filesystem::path& file, const Format& format, unsigned fps, const std::atomic<bool>& stop)
      : stop_(stop),
        format_(format),
        file_(name_of_film, file),
        lossless_(file_.path().string() + ".mkv"),
        palette_(file_.path().string() + ".png"),
        keeper_(std::in_place,
                joined(Words{ffmpeg()}, quietly, read_pictures(fps),
                       Words{"-c:v", "libx264rgb", "-preset", "ultrafast", "-qp", "0", "-f", "matroska",
                             url_of(lossless_.path)}),
                std::vector<int>{STDIN_FILENO}, stop) {}

  void add(std::string_view picture) override { keeper_->send(picture); }
  void finish() override {
    expect_success(*keeper_);
    run(joined(Words{ffmpeg()}, quietly,
               Words{"-i", url_of(lossless_.path), "-vf", "palettegen=stats_mode=full", "-frames:v", "1", "-update",
                     "1", "-c:v", "png", "-f", "image2", url_of(palette_.path)}));
    run(joined(Words{ffmpeg()}, quietly,
               Words{"-i", url_of(lossless_.path), "-i", url_of(palette_.path), "-lavfi",
                     "paletteuse=dither=bayer:bayer_scale=4:diff_mode=rectangle"},
               format_.options, repeatably, Words{url_of(file_.path())}));
    file_.commit();
  }

 private:
  void run(const Words& command) {
    ConnectedProgram program(command, {STDIN_FILENO}, stop_);
    expect_success(program);
  }

  const std::atomic<bool>& stop_;
  const Format& format_;
  AtomicFile file_;
  TemporaryFile lossless_;
  TemporaryFile palette_;
  std::optional<ConnectedProgram> keeper_;
};

class Picture final : public FilmWriter {
 public:
  explicit Picture(const std::filesystem::path& file) : file_("the picture", file) {}
  void add(std::string_view picture) override { file_.write(picture); }
  void finish() override { file_.commit(); }
  bool is_single() const override { return true; }

 private:
  AtomicFile file_;
};

// Each picture is written as a whole.
class NumberedPictures final : public FilmWriter {
 public:
  NumberedPictures(std::string before, std::size_t digits, std::string after)
      : before_(std::move(before)), digits_(digits), after_(std::move(after)) {}
  void add(std::string_view picture) override {
    AtomicFile file("the picture", before_ + fmt::format("{:0{}}", next_++, digits_) + after_);
    file.write(picture);
    file.commit();
  }
  void finish() override {}

 private:
  std::string before_;
  std::size_t digits_;
  std::string after_;
  std::size_t next_ = 0;
};

// Returns the writer of pictures, numbered if the name has a place for a number.
std::unique_ptr<FilmWriter> make_picture_writer(const std::filesystem::path& file) {
  if (!has_numbers(file)) return std::make_unique<Picture>(file);
  const std::string name = file.string();
  const std::size_t percent = name.find('%');
  const std::size_t end = name.find('d', percent);
  const std::string width = end == std::string::npos ? "x" : name.substr(percent + 1, end - percent - 1);
  const bool is_width = width.empty() || (width.size() == 2 && width[0] == '0' && width[1] >= '1' && width[1] <= '9');
  if (!is_width || name.find('%', percent + 1) != std::string::npos)
    throw std::invalid_argument(name + ": expected one place for a number, such as frame_%04d.png");
  const std::size_t digits = width.empty() ? 1 : static_cast<std::size_t>(width[1] - '0');
  return std::make_unique<NumberedPictures>(name.substr(0, percent), digits, name.substr(end + 1));
}

std::string lower_case(std::string text) {
  for (char& letter : text)
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  return text;
}

}  // namespace

bool has_numbers(const std::filesystem::path& file) {
  return lower_case(file.extension().string()) == ".png" && file.string().find('%') != std::string::npos;
}

std::unique_ptr<FilmWriter> make_film_writer(const std::filesystem::path& file, FilmSize size, unsigned fps,
                                             const std::atomic<bool>& stop) {
  const std::string extension = lower_case(file.extension().string());
  if (extension == ".png") return make_picture_writer(file);
  const auto format = std::ranges::find(formats(), extension, &Format::extension);
  if (format == formats().end())
    throw std::invalid_argument(
        fmt::format("{}: expected a file name that ends in .mp4, .webm, .gif, .webp or .png", file.string()));
  if (format->needs_even_size && (size.width % 2 != 0 || size.height % 2 != 0))
    throw std::invalid_argument(
        fmt::format("--size {}x{}: {} films have an even width and height", size.width, size.height, extension));
  if (extension == ".gif") return std::make_unique<GifFilm>(file, *format, fps, stop);
  return std::make_unique<EncodedFilm>(file, *format, fps, stop);
}

}  // namespace cohort::film
