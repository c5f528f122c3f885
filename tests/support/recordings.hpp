// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/recording/mcap/reading/mcap_reader.hpp"
#include "server/recording/mcap/writing/mcap_writer.hpp"

/// Small recordings for tests.
namespace cohort::test {

using recording::Bytes;
using recording::ByteView;
using recording::Timestamp;

inline ByteView bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }
inline std::string text_of(ByteView bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

inline void write_bytes(const std::filesystem::path& file, ByteView bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}
inline Bytes read_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const ByteView bytes = bytes_of(text);
  return {bytes.begin(), bytes.end()};
}

/// Returns the content of message `i` of `small_recording`.
inline std::string said(int i) { return "message " + std::to_string(i) + " of this recording"; }

/// Returns an MCAP file with the messages 0 to `count` - 1, alternately on the channels 1 `/even` and 2 `/odd`. The log
/// time of message i is 1000 i [ns]. Each chunk has `per_chunk` messages. The file also has an attachment `world.sdf`
/// and metadata `run`.
inline Bytes small_recording(int count, int per_chunk = 4, recording::McapWriterOptions options = {}) {
  Bytes file;
  recording::McapWriter writer([&](ByteView bytes) { file.insert(file.end(), bytes.begin(), bytes.end()); },
                               std::move(options));
  const auto schema = writer.add_schema("std_msgs/msg/String", "ros2msg", "string data\n");
  const recording::ChannelId channels[] = {writer.add_channel("/even", schema, "cdr", {{"offered_qos_profiles", ""}}),
                                           writer.add_channel("/odd", schema, "cdr", {{"offered_qos_profiles", ""}})};
  const ByteView world = bytes_of("<sdf version='1.9'/>");
  writer.add_attachment({Timestamp(0), Timestamp(0), "world.sdf", "application/xml", {world.begin(), world.end()}});
  for (int i = 0; i < count; ++i) {
    const Timestamp time(static_cast<std::uint64_t>(i) * 1000);
    writer.write_message(channels[i % 2], static_cast<std::uint32_t>(i), time, time, bytes_of(said(i)));
    if (i % per_chunk == per_chunk - 1) writer.flush_chunk();
  }
  writer.add_metadata({"run", {{"seed", "7"}, {"experiment", "demo"}}});
  writer.close();
  return file;
}

inline std::vector<std::string> messages_of(const recording::McapReader& reader,
                                            const recording::MessageQuery& query = {}) {
  std::vector<std::string> messages;
  recording::MessageStream stream = reader.messages(query);
  while (const auto message = stream.next()) messages.push_back(text_of(message->data));
  return messages;
}

/// A file that the destructor removes. It is in memory if /dev/shm exists, because recording often waits for the disk.
class TemporaryFile {
 public:
  explicit TemporaryFile(ByteView bytes = {}) {
    const std::filesystem::path memory = "/dev/shm";
    const bool has_memory = access(memory.c_str(), W_OK) == 0;
    std::string name =
        ((has_memory ? memory : std::filesystem::temp_directory_path()) / "cohort_recording_XXXXXX").string();
    const int descriptor = mkstemp(name.data());
    if (descriptor >= 0) close(descriptor);
    path_ = name;
    write_bytes(path_, bytes);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { std::filesystem::remove(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace cohort::test
