// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/avr/image.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>

namespace cohort::avr {
namespace {

constexpr std::size_t largest_file = 16U << 20U;

// How avr-gcc places the memories in one space of addresses.
constexpr std::uint32_t data_begins = 0x800000;
constexpr std::uint32_t eeprom_begins = 0x810000;
constexpr std::uint32_t eeprom_ends = 0x820000;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw std::runtime_error(file.string() + ": " + why);
}

std::vector<std::uint8_t> bytes_of(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) refuse(file, "no such file: expected an image in ELF or Intel HEX");
  if (std::filesystem::file_size(file) > largest_file) refuse(file, "is larger than 16 MiB, the limit for images");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse(file, "cannot be read");
  return {std::istreambuf_iterator<char>(stream), {}};
}

// ---- ELF ----

// Little-endian numbers of a file; every access is checked.
class Fields {
 public:
  Fields(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) : file_(file), bytes_(bytes) {}

  std::span<const std::uint8_t> at(std::size_t place, std::size_t size) const {
    if (place > bytes_.size() || size > bytes_.size() - place)
      refuse(file_, "the ELF file is truncated: it refers to byte " + std::to_string(place + size) + " of " +
                        std::to_string(bytes_.size()));
    return bytes_.subspan(place, size);
  }
  std::uint32_t u32(std::size_t place) const {
    const auto field = at(place, 4);
    return field[0] | field[1] << 8U | field[2] << 16U | static_cast<std::uint32_t>(field[3]) << 24U;
  }
  std::uint32_t u16(std::size_t place) const {
    const auto field = at(place, 2);
    return static_cast<std::uint32_t>(field[0] | field[1] << 8U);
  }
  std::string text(std::size_t place) const {
    std::string text;
    for (; at(place, 1)[0] != 0; ++place) text += static_cast<char>(at(place, 1)[0]);
    return text;
  }

 private:
  const std::filesystem::path& file_;
  std::span<const std::uint8_t> bytes_;
};

void add_segment(std::vector<Segment>& segments, std::uint32_t address, std::span<const std::uint8_t> bytes) {
  if (!bytes.empty()) segments.push_back({address, {bytes.begin(), bytes.end()}});
}

// The section .note.gnu.avr.deviceinfo of avr-gcc: a note of the sizes of all memories, and the device's name.
std::string device_in(std::span<const std::uint8_t> note) {
  constexpr std::size_t before_the_name = 12 + 4 + 24 + 8;
  std::string name;
  for (std::size_t i = before_the_name; i < note.size(); ++i) {
    if (note[i] != 0) name += static_cast<char>(note[i]);
    if (note[i] == 0 && !name.empty()) break;
  }
  return name;
}

// The section .mmcu of simavr: tags of one byte, sizes of one byte, values.
void read_mmcu(Image& image, std::span<const std::uint8_t> section) {
  constexpr std::uint8_t name_tag = 1, frequency_tag = 2;
  for (std::size_t i = 0; i + 2 <= section.size() && section[i] != 0;) {
    const std::uint8_t tag = section[i];
    const std::size_t size = std::min<std::size_t>(section[i + 1], section.size() - i - 2);
    const auto value = section.subspan(i + 2, size);
    if (tag == frequency_tag && size >= 4)
      image.frequency = value[0] | value[1] << 8U | value[2] << 16U | static_cast<std::uint32_t>(value[3]) << 24U;
    if (tag == name_tag) image.mcu.assign(value.begin(), std::ranges::find(value, 0));
    i += 2 + size;
  }
}

void read_segments(Image& image, const Fields& fields) {
  constexpr std::uint32_t loaded = 1;
  const std::size_t table = fields.u32(28), size = fields.u16(42), count = fields.u16(44);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t header = table + i * size;
    if (fields.u32(header) != loaded) continue;
    const auto bytes = fields.at(fields.u32(header + 4), fields.u32(header + 16));
    const std::uint32_t address = fields.u32(header + 12);  // where it is loaded, not where it is when it runs
    if (address < data_begins)
      add_segment(image.flash, address, bytes);
    else if (address >= eeprom_begins && address < eeprom_ends)
      add_segment(image.eeprom, address - eeprom_begins, bytes);
    // Fuses, lock bits and notes of tools do not decide what runs.
  }
}

void read_sections(Image& image, const Fields& fields) {
  constexpr std::uint32_t without_bytes = 8;
  const std::size_t table = fields.u32(32), size = fields.u16(46), count = fields.u16(48), names = fields.u16(50);
  if (names >= count) return;
  const std::size_t names_begin = fields.u32(table + names * size + 16);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t header = table + i * size;
    if (fields.u32(header + 4) == without_bytes) continue;
    const std::string name = fields.text(names_begin + fields.u32(header));
    if (name != ".note.gnu.avr.deviceinfo" && name != ".mmcu") continue;
    const auto bytes = fields.at(fields.u32(header + 16), fields.u32(header + 20));
    if (name == ".mmcu")
      read_mmcu(image, bytes);
    else if (image.mcu.empty())
      image.mcu = device_in(bytes);
  }
}

Image read_elf(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  constexpr std::uint32_t executable = 2, avr = 83;
  Image image{file.string()};
  const Fields fields(file, bytes);
  fields.at(0, 52);
  if (bytes[4] != 1 || bytes[5] != 1 || fields.u16(18) != avr)
    refuse(file, "is an ELF file for another processor (machine " + std::to_string(fields.u16(18)) +
                     "): expected one linked by avr-gcc");
  if (fields.u16(16) != executable) refuse(file, "is not linked: expected an executable, not an object file");
  read_segments(image, fields);
  read_sections(image, fields);
  return image;
}

// ---- Intel HEX ----

class HexLine {
 public:
  HexLine(const std::filesystem::path& file, std::size_t number, const std::string& text)
      : where_(file.string() + ":" + std::to_string(number) + ": ") {
    if (text.empty() || text[0] != ':') refuse("expected a record of Intel HEX, which begins with ':'");
    if (text.size() % 2 != 1) refuse("the number of hexadecimal digits is odd");
    std::uint8_t sum = 0;
    for (std::size_t i = 1; i < text.size(); i += 2) {
      bytes_.push_back(static_cast<std::uint8_t>(digit(text[i]) * 16 + digit(text[i + 1])));
      sum = static_cast<std::uint8_t>(sum + bytes_.back());
    }
    if (bytes_.size() < 5 || bytes_.size() != bytes_[0] + 5U)
      refuse("the record has " + std::to_string(bytes_.size()) + " bytes, which differs from its length field");
    if (sum != 0) refuse("wrong checksum");
  }
  std::uint32_t address() const { return static_cast<std::uint32_t>(bytes_[1] << 8U | bytes_[2]); }
  int type() const { return bytes_[3]; }
  std::span<const std::uint8_t> data() const { return std::span(bytes_).subspan(4, bytes_[0]); }
  std::uint32_t number() const {
    if (data().size() != 2) refuse("expected an address of two bytes");
    return static_cast<std::uint32_t>(data()[0] << 8U | data()[1]);
  }
  [[noreturn]] void refuse(const std::string& why) const { throw std::runtime_error(where_ + why); }

 private:
  int digit(char c) const {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    refuse("expected a hexadecimal digit");
  }
  std::string where_;
  std::vector<std::uint8_t> bytes_;
};

Image read_hex(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  constexpr int data = 0, end = 1, segment = 2, start_segment = 3, linear = 4, start_linear = 5;
  Image image{file.string()};
  std::uint32_t base = 0;
  std::size_t number = 0;
  for (auto rest = bytes.begin(); rest != bytes.end();) {
    const auto newline = std::find(rest, bytes.end(), '\n');
    std::string text(rest, newline);
    rest = newline == bytes.end() ? newline : newline + 1;
    ++number;
    while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.pop_back();
    if (text.empty()) continue;
    const HexLine line(file, number, text);
    switch (line.type()) {
      case data: add_segment(image.flash, base + line.address(), line.data()); break;
      case end: return image;
      case segment: base = line.number() << 4U; break;
      case linear: base = line.number() << 16U; break;
      case start_segment:
      case start_linear: break;
      default: line.refuse("unknown record type " + std::to_string(line.type()));
    }
  }
  refuse(file, "the end-of-file record is missing: the file is truncated");
}

}  // namespace

std::uint32_t Image::flash_end() const {
  std::uint32_t end = 0;
  for (const Segment& segment : flash)
    end = std::max(end, segment.address + static_cast<std::uint32_t>(segment.bytes.size()));
  return end;
}

Image read_image(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = bytes_of(file);
  const bool is_elf = bytes.size() >= 4 && std::memcmp(bytes.data(), "\177ELF", 4) == 0;
  const bool is_hex = !bytes.empty() && bytes[0] == ':';
  if (!is_elf && !is_hex) refuse(file, "is neither an ELF file nor Intel HEX");
  Image image = is_elf ? read_elf(file, bytes) : read_hex(file, bytes);
  if (image.flash.empty()) refuse(file, "contains no program for the flash memory");
  return image;
}

}  // namespace cohort::avr
