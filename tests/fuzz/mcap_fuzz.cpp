// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/reading/mcap_reader.hpp"
#include "server/recording/mcap/reading/recover.hpp"
#include "server/recording/ros_channels.hpp"
#include "tests/fuzz/fuzz_file.hpp"

namespace {

using namespace cohort::recording;

// So that the memory that a file may take is a matter of a test.
constexpr ReadLimits limits{.chunk_size = 1U << 20U, .open_chunks = 4U << 20U};

template <class Message>
void decode_any(ByteView bytes) {
  try {
    cohort::messages::decode<Message>(bytes);
  } catch (const cohort::messages::CdrError&) {
  }
}

void read(const std::filesystem::path& file, const ReadOptions& options) {
  try {
    const McapReader reader(file, options);
    for (const AttachmentIndex& index : reader.attachments()) reader.attachment(index);
    for (const MetadataIndex& index : reader.metadata()) reader.metadata(index);
    MessageStream messages = reader.messages();
    while (const std::optional<Message> message = messages.next()) {
      decode_any<ros::TFMessage>(message->data);
      decode_any<ros::JointState>(message->data);
      decode_any<ros::BatteryState>(message->data);
    }
  } catch (const McapError&) {
  }
}

}  // namespace

/// Any recording is read by its summary and without, or refused with McapError; what `recover` makes of it is whole.
// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it so.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const cohort::fuzz::FuzzFile holder(".mcap");
  const std::filesystem::path& file = holder.holding(data, size);
  read(file, {.limits = limits});
  read(file, {.limits = limits, .use_summary = false});
  try {
    const std::filesystem::path whole = file.parent_path() / "whole.mcap";
    recover(file, whole, limits);
    if (!McapReader(whole).is_complete()) std::abort();
  } catch (const McapError&) {
  }
  return 0;
}
