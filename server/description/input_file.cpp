#include "server/description/input_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace cohort::description {

std::optional<std::string> why_unreadable(const std::filesystem::path& file) {
  const auto because = [](const std::error_code& error) { return "the file cannot be read: " + error.message(); };
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) return "there is no such file";
  if (error) return because(error);
  if (std::filesystem::is_directory(status)) return "this is a folder; name a file in it";
  if (!std::filesystem::is_regular_file(status)) return "this is not a regular file";
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return because({errno, std::generic_category()});
  close(descriptor);
  return std::nullopt;
}

}  // namespace cohort::description
