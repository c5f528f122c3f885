// SPDX-License-Identifier: Apache-2.0
#include "tools/view/html/message_block.hpp"

#include <openssl/evp.h>
#include <zlib.h>

#include <algorithm>
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

// Appends the entries, the bytes of equal significance adjacent.
void append_by_significance(std::string& to, const std::vector<std::uint32_t>& entries) {
  const std::size_t begin = to.size();
  to.resize(begin + word_size * entries.size());
  for (std::size_t byte = 0; byte < word_size; ++byte)
    for (std::size_t i = 0; i < entries.size(); ++i)
      to[begin + byte * entries.size() + i] = static_cast<char>((entries[i] >> (8 * byte)) & 0xffu);
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
  messages_.push_back({topic, data.size(), words_of(data)});
  raw_size_ += data.size();
}

std::vector<MessageBlock::Series> MessageBlock::series() const {
  std::vector<Series> all;
  for (const Message& message : messages_) {
    const auto found = std::ranges::find_if(all, [&](const Series& each) {
      return each.front()->topic == message.topic && each.front()->size == message.size;
    });
    if (found != all.end())
      found->push_back(&message);
    else
      all.push_back({&message});
  }
  return all;
}

std::string MessageBlock::take_text() {
  std::string raw;
  append_number(raw, static_cast<std::uint32_t>(messages_.size()));
  for (const Message& message : messages_) {
    append_number(raw, static_cast<std::uint32_t>(message.topic));
    append_number(raw, static_cast<std::uint32_t>(message.size));
  }
  for (const Series& each : series()) {
    const bool has_differences = each.front()->topic != Topic::robots;
    append_number(raw, has_differences ? 1 : 0);
    std::vector<std::uint32_t> entries;
    entries.reserve(each.size() * each.front()->words.size());
    for (std::size_t word = 0; word < each.front()->words.size(); ++word) {
      std::uint32_t left = 0;
      for (const Message* const message : each) {
        const std::uint32_t value = message->words[word];
        entries.push_back(has_differences ? folded(value - left) : value);
        left = value;
      }
    }
    append_by_significance(raw, entries);
  }
  messages_.clear();
  raw_size_ = 0;
  return packed_text(raw);
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
