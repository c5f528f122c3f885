// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/reading/message_source.hpp"

#include <algorithm>

namespace cohort::recording {

MessageStream::MessageStream(std::unique_ptr<Source> source) : source_(std::move(source)) {}
MessageStream::MessageStream(MessageStream&&) noexcept = default;
MessageStream& MessageStream::operator=(MessageStream&&) noexcept = default;
MessageStream::~MessageStream() = default;
std::optional<Message> MessageStream::next() { return source_->next(); }

MessageStream::Source::Source(std::shared_ptr<const FileBytes> file, std::shared_ptr<const Contents> contents,
                              const ReadLimits& limits, MessageQuery query, bool is_strict)
    : file_(std::move(file)),
      contents_(std::move(contents)),
      limits_(limits),
      budget_(*file_, limits),
      query_(std::move(query)),
      is_strict_(is_strict) {
  std::ranges::sort(query_.channels);
  blocks_.reserve(contents_->blocks.size());
  for (const Block& block : contents_->blocks)
    if (is_wanted(block)) blocks_.push_back(&block);
  if (query_.order == Order::log_time)
    std::ranges::stable_sort(blocks_, {}, [](const Block* block) { return block->start_time; });
}

bool MessageStream::Source::is_wanted(const Block& block) const {
  if (block.end_time < query_.from || block.start_time > query_.to) return false;
  if (query_.channels.empty() || block.channels.empty()) return true;
  return std::ranges::any_of(block.channels,
                             [&](ChannelId channel) { return std::ranges::binary_search(query_.channels, channel); });
}

void MessageStream::Source::open(const Block& block) {
  OpenBlock opened;
  opened.block = &block;
  opened.records = read_block(*file_, block, limits_, budget_);
  for_each_record(opened.records, place_in(*file_, block), [&](const RecordView& record, const Place& place) {
    if (record.opcode != Opcode::message) return;
    const Message message = read_message(record.content, place);
    if (message.log_time < block.start_time || message.log_time > block.end_time)
      place.fail("a message at " + std::to_string(message.log_time.count()) + " ns is in a chunk from " +
                 std::to_string(block.start_time.count()) + " to " + std::to_string(block.end_time.count()) + " ns");
    if (message.log_time < query_.from || message.log_time > query_.to) return;
    if (!query_.channels.empty() && !std::ranges::binary_search(query_.channels, message.channel)) return;
    if (!contents_->channels.contains(message.channel)) {
      if (is_strict_) place.fail("a message has channel " + std::to_string(message.channel) + ", which is not defined");
      return;
    }
    opened.messages.emplace_back(message.log_time, record.offset);
  });
  if (opened.messages.empty()) return;
  if (query_.order == Order::log_time)
    std::ranges::stable_sort(opened.messages, {}, [](const auto& m) { return m.first; });
  open_bytes_ += opened.records.size();
  if (open_bytes_ > std::max<std::uint64_t>(limits_.open_chunks, opened.records.size()))
    file_->at(block.offset)
        .fail("chunks of more than " + std::to_string(limits_.open_chunks) +
              " bytes overlap in time here; read the file in file order");
  const auto slot = std::ranges::find(open_, nullptr, &OpenBlock::block);
  const auto index = static_cast<std::size_t>(slot - open_.begin());
  if (slot == open_.end()) open_.emplace_back();
  open_[index] = std::move(opened);
  add_head(index);
}

void MessageStream::Source::add_head(std::size_t index) {
  const OpenBlock& block = open_[index];
  heads_.push({block.messages[block.next].first, block.block->offset, index});
}

// Opens blocks. In order of time: all that may have a message before the next one. In file order: the next block, when
// none is open.
void MessageStream::Source::open_due() {
  while (next_block_ < blocks_.size()) {
    const Block& block = *blocks_[next_block_];
    const bool is_due = heads_.empty() || (query_.order == Order::log_time && block.start_time <= heads_.top().time);
    if (!is_due) return;
    ++next_block_;
    open(block);
  }
}

std::optional<Message> MessageStream::Source::next() {
  if (last_) {
    OpenBlock& block = open_[*last_];
    if (++block.next < block.messages.size()) {
      add_head(*last_);
    } else {
      open_bytes_ -= block.records.size();
      block = {};
    }
    last_.reset();
  }
  open_due();
  if (heads_.empty()) return {};
  const std::size_t index = heads_.top().index;
  heads_.pop();
  last_ = index;
  const OpenBlock& block = open_[index];
  const Place place = place_in(*file_, *block.block);
  const RecordView record = record_at(block.records, block.messages[block.next].second, place);
  return read_message(record.content, place);
}

}  // namespace cohort::recording
