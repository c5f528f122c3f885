// SPDX-License-Identifier: Apache-2.0
#include "tools/exec/program_file.hpp"

#include <elf.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace cohort::exec {
namespace {

constexpr int most_interpreters = 4;  // as the kernel has it

std::string head_of(const std::filesystem::path& file, std::size_t size, std::size_t offset = 0) {
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(offset));
  std::string head(size, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(size));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  return head;
}

template <class Value>
Value value_at(const std::string& bytes, std::size_t offset) {
  Value value{};
  if (offset + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

// Where `#!` is followed by env, the program that env finds.
std::string interpreter_of(const std::string& head) {
  std::istringstream line(head.substr(2, head.find('\n') - 2));
  std::string interpreter;
  line >> interpreter;
  if (std::filesystem::path(interpreter).filename() != "env") return interpreter;
  std::string word;
  while (line >> word)
    if (word.front() != '-') return file_of_command(word).string();
  return interpreter;
}

std::string why_not_elf(const std::string& head, const std::filesystem::path& file) {
  const auto header = value_at<Elf64_Ehdr>(head, 0);
  if (header.e_ident[EI_CLASS] != ELFCLASS64) return "it is a 32-bit program";
  std::ifstream self("/proc/self/exe", std::ios::binary);
  Elf64_Ehdr own{};
  self.read(reinterpret_cast<char*>(&own), sizeof own);
  if (header.e_machine != own.e_machine) return "it is a program for another processor architecture";
  const std::string table = head_of(file, std::size_t{header.e_phnum} * header.e_phentsize, header.e_phoff);
  bool has_loader = false;
  std::string notes;
  for (std::size_t i = 0; i < header.e_phnum; ++i) {
    const auto part = value_at<Elf64_Phdr>(table, i * header.e_phentsize);
    if (part.p_type == PT_INTERP) has_loader = true;
    constexpr std::size_t longest = 65536;
    if (part.p_type == PT_NOTE) notes += head_of(file, std::min<std::size_t>(part.p_filesz, longest), part.p_offset);
  }
  // The note of Go's build identity has the name "Go".
  if (notes.find(std::string("Go\0\0", 4)) != std::string::npos)
    return "it is a Go program, which makes system calls without the C library";
  if (!has_loader) return "it is linked statically; link it dynamically";
  return {};
}

}  // namespace

std::filesystem::path file_of_command(const std::string& command) {
  if (command.find('/') != std::string::npos) {
    if (::access(command.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(command)) return command;
    throw std::runtime_error("'" + command + "' is not an executable file");
  }
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/usr/local/bin:/usr/bin:/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    std::filesystem::path file = std::filesystem::path(folder.empty() ? "." : folder) / command;
    if (::access(file.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(file)) return file;
  }
  throw std::runtime_error("no program '" + command + "' in $PATH");
}

std::string why_not_virtual(const std::filesystem::path& program) {
  std::filesystem::path file = program;
  for (int i = 0; i < most_interpreters; ++i) {
    struct stat facts {};
    if (::stat(file.c_str(), &facts) != 0) return "there is no '" + file.string() + "'";
    if ((facts.st_mode & (S_ISUID | S_ISGID)) != 0) return "it is set-user-ID or set-group-ID";
    const std::string head = head_of(file, 4096);
    if (head.starts_with("#!")) {
      file = interpreter_of(head);
      continue;
    }
    return head.starts_with(ELFMAG) ? why_not_elf(head, file) : std::string("it is neither a program nor a script");
  }
  return "its interpreter is a script, whose interpreter is a script as well";
}

}  // namespace cohort::exec
