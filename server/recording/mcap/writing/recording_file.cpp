// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/writing/recording_file.hpp"

#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <limits>

#include "server/recording/mcap/format/mcap_error.hpp"
#include "server/recording/mcap/writing/disk_file.hpp"

namespace cohort::recording {
namespace {

constexpr std::size_t block_size = 256U << 10U;
constexpr std::size_t wake_size = 512U << 10U;  // queued bytes at which the writer is woken early
constexpr std::size_t most_spare = 16;
constexpr int writer_niceness = 10;
constexpr const char* no_memory = "out of memory";

// The head of a message in a block, or an entry instead of one.
struct Entry {
  MessageHead head;
  std::uint64_t size = 0;
  bool is_call = false;
};

// Starts a thread that receives no signals: they are the program's. SIGXFSZ, which would end the program at its limit
// of the file size, becomes an error of `write`.
template <class Function>
std::thread quiet_thread(const Function& function) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  try {
    std::thread thread(function);
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return thread;
  } catch (...) {
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    throw;
  }
}

}  // namespace

RecordingFile::RecordingFile(const std::filesystem::path& path, RecordingOptions options)
    : RecordingFile(std::make_shared<DiskFile>(path), std::move(options)) {}

RecordingFile::RecordingFile(std::shared_ptr<ByteStore> store, RecordingOptions options)
    : options_(std::move(options)),
      store_(std::move(store)),
      writer_([this](ByteView bytes) { write(bytes); }, options_.mcap) {
  sync_thread_ = quiet_thread([this] { sync_now_and_then(); });
  try {
    writer_thread_ = quiet_thread([this] {
      write_blocks();
      const std::lock_guard lock(mutex_);
      is_closed_ = true;
      flushed_.notify_all();
    });
  } catch (...) {
    stop_syncing();
    throw;
  }
}

RecordingFile::~RecordingFile() { close(); }

// Retries a failed write once, as the run cannot be repeated.
void RecordingFile::write(ByteView bytes) {
  try {
    store_->write(bytes);
  } catch (const FileError&) {
    store_->cut_off(size_);
    store_->write(bytes);
  }
  size_ += bytes.size();
}

RecordingFile::Block& RecordingFile::block_for(std::size_t size) {
  if (!queue_.empty() && queue_.back().bytes.capacity() - queue_.back().bytes.size() >= size) return queue_.back();
  if (spare_.empty() || size > block_size) {
    queue_.emplace_back();
    queue_.back().bytes.reserve(std::max(size, block_size));
  } else {
    queue_.push_back(std::move(spare_.back()));
    spare_.pop_back();
  }
  return queue_.back();
}

// Requires the lock.
void RecordingFile::add_entry(const MessageHead& head, std::uint64_t size, bool is_call, ByteView data) {
  const Entry entry{head, size, is_call};
  Block& block = block_for(sizeof entry + data.size());
  const std::size_t at = block.bytes.size();
  block.bytes.resize(at + sizeof entry + data.size());
  std::memcpy(block.bytes.data() + at, &entry, sizeof entry);
  if (!data.empty()) std::memcpy(block.bytes.data() + at + sizeof entry, data.data(), data.size());
  const std::size_t before = queued_;
  queued_ += sizeof entry + size;
  const bool is_first = !first_queued_at_;
  if (is_first) first_queued_at_ = Clock::now();
  if (is_first || (before < wake_size && queued_ >= wake_size)) wake_.notify_one();
}

// Requires the lock.
void RecordingFile::end(const std::string& why) {
  if (!error_.empty()) return;
  error_ = store_->name() + " ends early: " + why + ". The messages recorded until then are intact";
  is_closing_ = true;
  wake_.notify_one();
}

void RecordingFile::end_early(const std::string& why) {
  const std::lock_guard lock(mutex_);
  end(why);
}

// Requires the lock. Returns false if it is out of memory, which ends only the recording.
template <class Add>
bool RecordingFile::is_added(const Add& add) {
  try {
    add();
    return true;
  } catch (const std::bad_alloc&) {
    end(no_memory);
    return false;
  }
}

bool RecordingFile::write_message(ChannelId channel, std::uint32_t sequence, Timestamp log_time, Timestamp publish_time,
                                  ByteView data, Importance importance) noexcept {
  const std::lock_guard lock(mutex_);
  if (is_closing_ || !error_.empty()) return false;
  if (importance == Importance::display && queued_ + data.size() > options_.most_queued) {
    ++dropped_[channel];
    return false;
  }
  if (queued_ + data.size() > options_.most_essential_queued) {
    end(std::to_string(queued_ >> 20U) + " MiB are waiting to be written, which is the limit");
    return false;
  }
  return is_added([&] { add_entry({channel, sequence, log_time, publish_time}, data.size(), false, data); });
}

void RecordingFile::add_call(Call call, std::size_t bytes) {
  if (is_closing_ || !error_.empty()) return;
  is_added([&] {
    add_entry({}, bytes, true, {});
    queue_.back().calls.push_back(std::move(call));
  });
}

SchemaId RecordingFile::add_schema(std::string name, std::string encoding, std::string data) noexcept {
  const std::lock_guard lock(mutex_);
  const Schema schema{++last_schema_, std::move(name), std::move(encoding), std::move(data)};
  add_call([schema](McapWriter& writer) { writer.add(schema); }, schema.data.size());
  return schema.id;
}

ChannelId RecordingFile::add_channel(std::string topic, SchemaId schema, std::string message_encoding,
                                     StringMap metadata) noexcept {
  const std::lock_guard lock(mutex_);
  const Channel channel{++last_channel_, schema, std::move(topic), std::move(message_encoding), std::move(metadata)};
  add_call([channel](McapWriter& writer) { writer.add(channel); }, channel.topic.size());
  return channel.id;
}

void RecordingFile::add_attachment(Attachment attachment) noexcept {
  const std::size_t size = attachment.data.size();
  const auto shared = std::make_shared<const Attachment>(std::move(attachment));
  const std::lock_guard lock(mutex_);
  add_call([shared](McapWriter& writer) { writer.add_attachment(*shared); }, size);
}

void RecordingFile::add_metadata(Metadata metadata) noexcept {
  const std::lock_guard lock(mutex_);
  add_call([metadata = std::move(metadata)](McapWriter& writer) { writer.add_metadata(metadata); }, 0);
}

std::map<ChannelId, std::uint64_t> RecordingFile::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

std::size_t RecordingFile::queued() const {
  const std::lock_guard lock(mutex_);
  return queued_;
}

std::optional<std::string> RecordingFile::error() const {
  const std::lock_guard lock(mutex_);
  return error_.empty() ? std::nullopt : std::optional(error_);
}

void RecordingFile::begin_closing() {
  {
    const std::lock_guard lock(mutex_);
    is_closing_ = true;
  }
  wake_.notify_one();
}

bool RecordingFile::is_closed() const {
  const std::lock_guard lock(mutex_);
  return is_closed_;
}

void RecordingFile::flush() {
  std::unique_lock lock(mutex_);
  const std::uint64_t flush = ++flushes_wanted_;
  wake_.notify_one();
  flushed_.wait(lock, [&] { return flushes_done_ >= flush || is_closed_; });
}

void RecordingFile::close() {
  begin_closing();
  if (writer_thread_.joinable()) writer_thread_.join();
  stop_syncing();
}

// The writer's thread runs this function and those down to `give_up`.
void RecordingFile::write_blocks() {
  // Linux has a niceness for each thread: without a spare core, the run and its controllers have priority.
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), writer_niceness);
  std::deque<Block> blocks;
  bool is_last = false;
  while (!is_last) {
    std::uint64_t flushes = 0;
    is_last = wait_for_blocks(blocks, flushes);
    try {
      for (; !blocks.empty(); blocks.pop_front()) {
        write_block(blocks.front());
        release(std::move(blocks.front()));
      }
      const bool is_flushed = flushes > flushes_done_;  // which no other thread writes
      end_chunk_if_due(is_last, is_flushed);
      ask_for_sync();
      if (is_flushed) {
        const std::lock_guard lock(mutex_);
        flushes_done_ = flushes;
        flushed_.notify_all();
      }
      if (is_last) {
        writer_.close();
        store_->finish();
      }
    } catch (const std::exception& reason) {
      give_up(reason);
      return;
    }
  }
}

// Takes the queued blocks when they are large or old enough, when a flush waits, or at the end. Returns true at the
// end. `flushes`: number of flushes requested so far.
bool RecordingFile::wait_for_blocks(std::deque<Block>& blocks, std::uint64_t& flushes) {
  std::unique_lock lock(mutex_);
  while (!is_closing_ && queued_ < wake_size && flushes_wanted_ == flushes_done_) {
    const bool is_waiting = first_queued_at_ || chunk_began_at_;
    if (!is_waiting) {
      wake_.wait(lock);
      continue;
    }
    constexpr auto never = Clock::time_point::max();
    const auto oldest = std::min(first_queued_at_.value_or(never), chunk_began_at_.value_or(never));
    if (wake_.wait_until(lock, oldest + options_.flush_interval) == std::cv_status::timeout) break;
  }
  blocks.swap(queue_);
  flushes = flushes_wanted_;
  if (!chunk_began_at_) chunk_began_at_ = first_queued_at_;
  first_queued_at_.reset();
  return is_closing_;
}

void RecordingFile::write_block(const Block& block) {
  std::size_t next_call = 0;
  for (ByteView bytes = block.bytes; !bytes.empty();) {
    Entry entry;
    std::memcpy(&entry, bytes.data(), sizeof entry);
    bytes = bytes.subspan(sizeof entry);
    if (entry.is_call) {
      block.calls[next_call++](writer_);
      continue;
    }
    const ByteView data = bytes.first(static_cast<std::size_t>(entry.size));
    bytes = bytes.subspan(data.size());
    const MessageHead& head = entry.head;
    writer_.write_message(head.channel, head.sequence, head.log_time, head.publish_time, data);
  }
}

void RecordingFile::end_chunk_if_due(bool is_last, bool is_flushed) {
  if (writer_.pending_messages() == 0) chunk_began_at_.reset();
  if (is_last || !chunk_began_at_) return;
  if (!is_flushed && Clock::now() - *chunk_began_at_ < options_.flush_interval) return;
  writer_.flush_chunk();
  chunk_began_at_.reset();
}

void RecordingFile::ask_for_sync() {
  if (writer_.size() == size_to_sync_) return;
  size_to_sync_ = writer_.size();
  const std::lock_guard lock(sync_mutex_);
  wants_sync_ = true;
  sync_wake_.notify_one();
}

void RecordingFile::release(Block block) {
  std::size_t size = 0;
  for (ByteView bytes = block.bytes; !bytes.empty();) {
    Entry entry;
    std::memcpy(&entry, bytes.data(), sizeof entry);
    size += sizeof entry + static_cast<std::size_t>(entry.size);
    bytes = bytes.subspan(sizeof entry + (entry.is_call ? 0 : static_cast<std::size_t>(entry.size)));
  }
  block.bytes.clear();
  block.calls.clear();
  const std::lock_guard lock(mutex_);
  queued_ -= size;
  if (block.bytes.capacity() == block_size && spare_.size() < most_spare) spare_.push_back(std::move(block));
}

// Closes the file, with the current chunk if that can be written now, or without it.
void RecordingFile::give_up(const std::exception& reason) {
  const bool lacks_memory = dynamic_cast<const std::bad_alloc*>(&reason) != nullptr;
  const std::string text = lacks_memory ? store_->name() + " ends early: " + no_memory : reason.what();
  std::string rest;
  for (const bool with_chunk : {true, false}) {
    rest = is_closed_up(with_chunk);
    if (rest.empty()) break;
  }
  const std::uint64_t count = writer_.statistics().message_count;
  const std::string messages = std::to_string(count) + " messages recorded until then";
  if (rest.empty())
    rest = "The file contains the " + messages + " and was closed";
  else if (count > 0)
    rest = "The file contains the " + messages + " but is not closed; 'cohort recover' closes it" + keep_unclosed();
  else
    rest = "Nothing was recorded; an existing file is unchanged";
  const std::lock_guard lock(mutex_);
  error_ = text + ". " + rest;
  queue_.clear();
  spare_.clear();
  queued_ = 0;
}

// Returns an empty text if the file was closed, otherwise the reason.
std::string RecordingFile::is_closed_up(bool with_chunk) {
  try {
    store_->cut_off(size_);
    if (!with_chunk) writer_.discard_chunk();
    writer_.close();
    store_->finish();
    return "";
  } catch (const std::exception& problem) {
    return problem.what();
  }
}

std::string RecordingFile::keep_unclosed() {
  try {
    store_->cut_off(size_);
    store_->finish();
    return "";
  } catch (const std::exception& problem) {
    return " (" + std::string(problem.what()) + ")";
  }
}

// Runs on a thread of its own, so that chunks reach the operating system while the disk is slow.
void RecordingFile::sync_now_and_then() {
  std::unique_lock lock(sync_mutex_);
  while (!ends_syncing_) {
    sync_wake_.wait(lock, [this] { return wants_sync_ || ends_syncing_; });
    if (ends_syncing_) return;
    wants_sync_ = false;
    lock.unlock();
    std::string problem;
    try {
      store_->sync();
    } catch (const std::exception& error) {
      problem = error.what();
    }
    if (!problem.empty()) {
      const std::lock_guard main_lock(mutex_);
      if (error_.empty()) error_ = problem + ". The messages of the last seconds may be lost";
    }
    lock.lock();
    sync_wake_.wait_for(lock, std::chrono::seconds(1), [this] { return ends_syncing_; });
  }
}

void RecordingFile::stop_syncing() {
  {
    const std::lock_guard lock(sync_mutex_);
    ends_syncing_ = true;
  }
  sync_wake_.notify_one();
  if (sync_thread_.joinable()) sync_thread_.join();
}

}  // namespace cohort::recording
