#include "tools/view/html/message_block.hpp"

#include <openssl/evp.h>
#include <zlib.h>

#include <bit>
#include <cstring>
#include <new>
#include <stdexcept>
#include <utility>

namespace cohort::view {
namespace {

static_assert(std::endian::native == std::endian::little, "pages hold little-endian numbers");

constexpr std::size_t word_size = sizeof(std::uint32_t);

void append_number(std::string& to, std::uint32_t number) {
  to.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::vector<std::uint32_t> words_of(const recording::Bytes& data) {
  std::vector<std::uint32_t> words((data.size() + word_size - 1) / word_size);
  if (!data.empty()) std::memcpy(words.data(), data.data(), data.size());
  return words;
}

// Maps small positive and negative differences to small numbers.
std::uint32_t folded(std::uint32_t difference) {
  constexpr int sign_bit = 31;
  return (difference << 1) ^ (0u - (difference >> sign_bit));
}

std::string compressed(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  const int result = compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_BEST_COMPRESSION);
  if (result != Z_OK) throw std::bad_alloc();  // the only reason with a buffer of this size
  packed.resize(size);
  return packed;
}

}  // namespace

void MessageBlock::add(Topic topic, const recording::Bytes& data) {
  append_number(raw_, static_cast<std::uint32_t>(topic));
  append_number(raw_, static_cast<std::uint32_t>(data.size()));
  std::vector<std::uint32_t> words = words_of(data);
  std::vector<std::uint32_t>& last = last_[topic];
  if (last.size() != words.size()) last.assign(words.size(), 0);
  const std::size_t begin = raw_.size();
  raw_.resize(begin + word_size * words.size());
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::uint32_t difference = folded(words[i] - last[i]);
    for (std::size_t byte = 0; byte < word_size; ++byte)
      raw_[begin + byte * words.size() + i] = static_cast<char>((difference >> (8 * byte)) & 0xffu);
  }
  last = std::move(words);
}

std::string MessageBlock::take_text() {
  std::string text = packed_text(raw_);
  raw_.clear();
  last_.clear();
  return text;
}

std::string packed_text(std::string_view bytes) {
  const std::string packed = compressed(bytes);
  constexpr std::size_t most = std::size_t{1} << 30;  // OpenSSL counts in int
  if (packed.size() > most) throw std::length_error("a message is too large for a page");
  std::string text(4 * ((packed.size() + 2) / 3) + 1, '\0');
  const int size =
      EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                      reinterpret_cast<const unsigned char*>(packed.data()), static_cast<int>(packed.size()));
  text.resize(static_cast<std::size_t>(size));
  return text;
}

}  // namespace cohort::view
