#include "server/parsing/files/xacro.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>

extern char** environ;

namespace cohort::parsing {
namespace {

constexpr std::size_t longest_output = 64u << 20;  // [bytes]

std::string xacro_program() {
  const char* const environment = std::getenv("VIRTUAL_ENV");
  std::string own = std::string(environment != nullptr ? environment : "") + "/bin/xacro";
  return environment != nullptr && access(own.c_str(), X_OK) == 0 ? own : "xacro";
}

std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 4096> part{};
  while (text.size() < longest_output) {
    const ssize_t count = read(descriptor, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    text.append(part.data(), static_cast<std::size_t>(count));
  }
  return text;
}

}  // namespace

std::string expand_xacro(const std::filesystem::path& file) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("xacro cannot be started");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  std::string program = xacro_program();
  std::string path = file.string();
  char* arguments[] = {program.data(), path.data(), nullptr};
  pid_t process = 0;
  const int failed = posix_spawnp(&process, program.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (failed != 0) {
    close(ends[0]);
    throw std::runtime_error(
        "this is a xacro file, and there is no xacro here: install it (`pip install xacro`), or give the URDF that "
        "`xacro FILE` makes of it");
  }
  std::string text = read_all(ends[0]);
  close(ends[0]);
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) continue;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw std::runtime_error("xacro cannot make a URDF of this file; `xacro " + path + "` says why");
  return text;
}

}  // namespace cohort::parsing
