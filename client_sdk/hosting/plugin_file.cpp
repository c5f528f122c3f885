// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/hosting/plugin_file.hpp"

#include <elf.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "client_sdk/include/cohort/controller.hpp"

namespace cohort {
namespace {

static_assert(sizeof(void*) == 8, "plugins are read as 64-bit ELF files");

constexpr std::uint64_t largest_table = 64U << 20U;  // bytes

// Reads parts of an ELF file. Throws std::out_of_range if the file is shorter than its headers claim.
class ElfFile {
 public:
  explicit ElfFile(const std::filesystem::path& path)
      : file_(path, std::ios::binary), size_(std::filesystem::file_size(path)) {}

  template <class T>
  std::vector<T> table(std::uint64_t offset, std::uint64_t bytes) {
    if (bytes > largest_table || offset > size_ || bytes > size_ - offset)
      throw std::out_of_range("a table lies beyond the end of the file");
    std::vector<T> entries(bytes / sizeof(T));
    file_.seekg(static_cast<std::streamoff>(offset));
    file_.read(reinterpret_cast<char*>(entries.data()), static_cast<std::streamsize>(entries.size() * sizeof(T)));
    if (!file_) throw std::out_of_range("the file cannot be read");
    return entries;
  }
  template <class T>
  T one(std::uint64_t offset) {
    return table<T>(offset, sizeof(T)).front();
  }

  std::uint64_t size() const { return size_; }

 private:
  std::ifstream file_;
  std::uint64_t size_;
};

bool is_shared_object_or_program(ElfFile& file) {
  if (file.size() < sizeof(Elf64_Ehdr)) return false;
  const auto header = file.one<Elf64_Ehdr>(0);
  return std::memcmp(header.e_ident, ELFMAG, SELFMAG) == 0 && (header.e_type == ET_DYN || header.e_type == ET_EXEC);
}

// An executable that may be loaded anywhere is a shared object too, but nothing can load it as one.
bool is_program(const Elf64_Ehdr& header, ElfFile& file) {
  if (header.e_type == ET_EXEC) return true;
  for (const auto& segment :
       file.table<Elf64_Phdr>(header.e_phoff, std::uint64_t{header.e_phnum} * sizeof(Elf64_Phdr))) {
    if (segment.p_type != PT_DYNAMIC) continue;
    for (const Elf64_Dyn& entry : file.table<Elf64_Dyn>(segment.p_offset, segment.p_filesz))
      if (entry.d_tag == DT_FLAGS_1 && (entry.d_un.d_val & DF_1_PIE) != 0) return true;
  }
  return false;
}

std::string why_no_program(const std::filesystem::path& path) {
  const std::filesystem::path plugin = path.string() + ".so";
  const std::string is_program = path.string() + " is a program, not a plugin. ";
  std::error_code none;
  if (std::filesystem::is_regular_file(plugin, none)) return is_program + "Its plugin is " + plugin.string();
  return is_program + "A plugin is a shared object; cohort_add_controller builds it beside the program";
}

bool is_of_this_machine(const Elf64_Ehdr& header) {
  const auto own = ElfFile("/proc/self/exe").one<Elf64_Ehdr>(0);
  return header.e_ident[EI_CLASS] == own.e_ident[EI_CLASS] && header.e_ident[EI_DATA] == own.e_ident[EI_DATA] &&
         header.e_machine == own.e_machine;
}

// Returns the address of a symbol that the file exports.
std::optional<std::uint64_t> address_of(std::string_view name, const Elf64_Ehdr& header, ElfFile& file) {
  const auto sections = file.table<Elf64_Shdr>(header.e_shoff, std::uint64_t{header.e_shnum} * sizeof(Elf64_Shdr));
  for (const Elf64_Shdr& section : sections) {
    if (section.sh_type != SHT_DYNSYM) continue;
    if (section.sh_link >= sections.size()) throw std::out_of_range("the symbol table has no names");
    const Elf64_Shdr& names_section = sections[section.sh_link];
    const auto names = file.table<char>(names_section.sh_offset, names_section.sh_size);
    for (const Elf64_Sym& symbol : file.table<Elf64_Sym>(section.sh_offset, section.sh_size)) {
      if (symbol.st_shndx == SHN_UNDEF || symbol.st_name >= names.size()) continue;
      const auto begin = names.begin() + symbol.st_name;
      if (std::string_view(begin, std::find(begin, names.end(), '\0')) == name) return symbol.st_value;
    }
  }
  return std::nullopt;
}

// Returns the initial value at an address, before relocation.
std::uint32_t value_at(std::uint64_t address, const Elf64_Ehdr& header, ElfFile& file) {
  for (const auto& segment :
       file.table<Elf64_Phdr>(header.e_phoff, std::uint64_t{header.e_phnum} * sizeof(Elf64_Phdr))) {
    if (segment.p_type != PT_LOAD || address < segment.p_vaddr) continue;
    const std::uint64_t offset = address - segment.p_vaddr;
    if (offset < segment.p_filesz && segment.p_filesz - offset >= sizeof(std::uint32_t))
      return file.one<std::uint32_t>(segment.p_offset + offset);
  }
  throw std::out_of_range("the symbol cohort_plugin is outside all segments");
}

}  // namespace

void check_plugin_file(const std::filesystem::path& path) {
  try {
    ElfFile file(path);
    if (!is_shared_object_or_program(file))
      throw std::runtime_error(path.string() +
                               " is not a shared object. Build the plugin with cohort_add_controller in CMake");
    const auto header = file.one<Elf64_Ehdr>(0);
    if (!is_of_this_machine(header))
      throw std::runtime_error(path.string() +
                               " is a shared object for another machine. Build the plugin for this machine");
    if (is_program(header, file)) throw std::runtime_error(why_no_program(path));
    const auto address = address_of("cohort_plugin", header, file);
    if (!address)
      throw std::runtime_error(
          path.string() +
          " is not a controller plugin: the symbol cohort_plugin is missing. End the controller's source with "
          "COHORT_CONTROLLER(Class), which defines it");
    check_plugin_abi(path, value_at(*address, header, file));
  } catch (const std::out_of_range& error) {
    throw std::runtime_error(path.string() + " is damaged: " + error.what() + ". Rebuild the plugin");
  }
}

void check_plugin_abi(const std::filesystem::path& path, std::uint32_t abi) {
  if (abi >= Plugin::oldest_abi && abi <= Plugin::current_abi) return;
  throw std::runtime_error(path.string() + " was built for version " + std::to_string(abi) +
                           " of the controller interface; this program supports versions " +
                           std::to_string(Plugin::oldest_abi) + " to " + std::to_string(Plugin::current_abi) +
                           ". Rebuild the plugin with the headers of this version");
}

}  // namespace cohort
