// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/files/xacro.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "idl/text/printable.hpp"
#include "server/core/text.hpp"
#include "server/description/input_error.hpp"

extern char** environ;

namespace cohort::parsing {
namespace {

constexpr std::size_t longest_output = 64u << 20;  // [bytes]
constexpr std::size_t longest_complaint = 1000;    // [bytes]

const XmlNode* find_macro_in(const XmlNode& node, bool may_have_expressions) {
  const auto has_expression = [](const auto& attribute) { return attribute.second.find("${") != std::string::npos; };
  if (node.name.starts_with("xacro:") || (may_have_expressions && std::ranges::any_of(node.attributes, has_expression)))
    return &node;
  for (const XmlNode& child : node.children)
    if (const XmlNode* const found = find_macro_in(child, may_have_expressions)) return found;
  return nullptr;
}

std::string xacro_program() {
  const char* const environment = std::getenv("VIRTUAL_ENV");
  std::string own = std::string(environment != nullptr ? environment : "") + "/bin/xacro";
  return environment != nullptr && access(own.c_str(), X_OK) == 0 ? own : "xacro";
}

/// A pipe that closes its ends when it is destroyed.
struct Pipe {
  Pipe() {
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("xacro cannot be started");
  }
  ~Pipe() {
    for (const int end : ends)
      if (end >= 0) close(end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close_writing_end() { close(std::exchange(ends[1], -1)); }

  int ends[2] = {-1, -1};
};

// Returns false at the end.
bool read_part(int descriptor, std::string& text) {
  std::array<char, 4096> part{};
  const ssize_t count = read(descriptor, part.data(), part.size());
  if (count < 0 && errno == EINTR) return true;
  if (count <= 0) return false;
  text.append(part.data(), static_cast<std::size_t>(count));
  return true;
}

// Reads both concurrently, so that neither pipe fills up. The error is at the end of the complaint, after warnings.
void read_both(int output, int complaint, std::string& text, std::string& complaints) {
  std::array<pollfd, 2> open{{{output, POLLIN, 0}, {complaint, POLLIN, 0}}};
  while (open[0].fd >= 0 || open[1].fd >= 0) {
    if (poll(open.data(), open.size(), -1) < 0 && errno != EINTR) return;
    if (open[0].revents != 0 && (!read_part(output, text) || text.size() > longest_output)) open[0].fd = -1;
    if (open[1].revents != 0 && !read_part(complaint, complaints)) open[1].fd = -1;
    if (complaints.size() > longest_complaint) complaints.erase(0, complaints.size() - longest_complaint);
    if (text.size() > longest_output) return;
  }
}

std::string in_one_line(std::string_view complaint) {
  std::string line;
  for (const std::string_view word : words(complaint)) line += (line.empty() ? "" : " ") + std::string(word);
  return printable(line);
}

std::string expanded(const std::filesystem::path& file) {
  Pipe output;
  Pipe complaint;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output.ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, complaint.ends[1], STDERR_FILENO);
  std::string program = xacro_program();
  std::string path = file.string();
  char* arguments[] = {program.data(), path.data(), nullptr};
  pid_t process = 0;
  const int failed = posix_spawnp(&process, program.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0)
    throw std::runtime_error(
        "the program 'xacro' was not found; install it (`pip install xacro`), or use the URDF that `xacro " +
        file.filename().string() + " > robot.urdf` writes on another machine");
  output.close_writing_end();
  complaint.close_writing_end();
  std::string text;
  std::string complaints;
  read_both(output.ends[0], complaint.ends[0], text, complaints);
  const bool is_too_long = text.size() > longest_output;
  if (is_too_long) kill(process, SIGKILL);
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) continue;
  if (is_too_long) throw std::runtime_error("the output of xacro for this file exceeds 64 MiB");
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    const std::string said = in_one_line(complaints);
    throw std::runtime_error("xacro cannot expand this file" + (said.empty() ? "" : ": " + said));
  }
  return text;
}

}  // namespace

const XmlNode* find_macro(const XmlNode& root, const std::filesystem::path& file) {
  return find_macro_in(root, root.attribute("xmlns:xacro") != nullptr || file.extension() == ".xacro");
}

std::string why_not_expanded(const std::filesystem::path& file) {
  return "this is a xacro file, whose expansion can execute code; run `xacro " + file.filename().string() +
         " > robot.urdf` and use robot.urdf, or use --xacro if you trust the file";
}

void expand_named(InputFiles& input, const std::filesystem::path& file) {
  if (input.why_unreadable(file)) return;  // reported where it is read
  const std::filesystem::path absolute = input.absolute(file);
  const XmlOutline outline = outline_xml(input.read(absolute));
  const XmlNode* const macro = find_macro(outline.root, file);
  if (macro == nullptr) return;
  const auto fail = [&](std::string message) {
    throw description::InputError({{file, macro->line, "", std::move(message)}});
  };
  std::string text;
  try {
    text = expanded(absolute);
  } catch (const std::runtime_error& error) {
    fail(error.what());
  }
  if (const XmlOutline made = outline_xml(text); made.error)
    fail("the output of xacro is not XML: line " + std::to_string(made.error->line) + ": " + made.error->message);
  input.add_expanded(absolute, std::move(text));
}

}  // namespace cohort::parsing
