// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/common/picture_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "server/core/atomic_file.hpp"
#include "tools/cli/common/output_file.hpp"
#include "tools/common/processes/external_program.hpp"

namespace cohort::tool {
namespace {

// Returns the extension without its dot, in small letters.
std::string picture_format(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  std::ranges::transform(extension, extension.begin(), [](char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  });
  return extension;
}

}  // namespace

void check_picture_file(const std::filesystem::path& file) {
  const std::string format = picture_format(file);
  if (format == "svg") return;
  if (format != "png" && format != "pdf")
    throw std::invalid_argument(fmt::format("{}: expected a file name that ends in .svg, .png or .pdf", file.string()));
  try {
    run_program({"rsvg-convert", "--version"}, std::filesystem::current_path());
  } catch (const std::runtime_error&) {
    throw std::runtime_error(fmt::format(
        "{}: the program rsvg-convert, which draws such files, is missing; install librsvg2-bin, or write .svg",
        file.string()));
  }
}

void write_picture(const std::filesystem::path& file, const std::string& svg) {
  const std::string format = picture_format(file);
  if (format == "svg") return write_file("the picture", file, svg);
  AtomicFile picture("the picture", std::filesystem::absolute(file));
  const std::filesystem::path source = picture.path().string() + ".svg";
  write_file("the picture", source, svg);
  const ProgramResult result =
      run_program({"rsvg-convert", "--format", format, "--background-color", "white", "--zoom",
                   format == "png" ? "2" : "1", "--output", picture.path().string(), source.string()},
                  picture.path().parent_path());
  std::filesystem::remove(source);
  if (result.exit_code != 0)
    throw WriteError(fmt::format("cannot draw {}: rsvg-convert reports {}", file.string(), result.errors));
  picture.commit();
}

}  // namespace cohort::tool
