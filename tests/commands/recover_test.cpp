// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <csignal>

#include "server/recording/mcap/writing/disk_file.hpp"
#include "tests/commands/small_experiment.hpp"
#include "tests/support/recordings.hpp"

// `cohort recover` as its users see it.
namespace cohort::test {
namespace {

using recording::Bytes;
using recording::ByteView;
using recording::McapReader;

Ended recover(const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {cohort_program(), "recover"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run_to_end(command);
}

TEST(RecoverCommand, RepairsAFileInPlaceAndReportsTheLoss) {
  const ScratchFolder folder;
  const std::string file = folder / "run.mcap";
  const Bytes bytes = test::small_recording(20);
  test::write_bytes(file, ByteView(bytes).first(bytes.size() / 2));
  const std::uint64_t readable = McapReader(file).statistics().message_count;
  ASSERT_GT(readable, 0U);

  const Ended ended = recover({file});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_TRUE(ended.out.starts_with(file + ": kept " + std::to_string(readable) + " messages in ")) << ended.out;
  EXPECT_NE(ended.out.find("\nlost "), std::string::npos) << ended.out;
  EXPECT_TRUE(McapReader(file).is_complete());
  EXPECT_EQ(McapReader(file).statistics().message_count, readable);

  const Ended again = recover({file});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.out.find("nothing was lost: the file is complete"), std::string::npos) << again.out;
}

TEST(RecoverCommand, WritesAnotherFileAndKeepsTheFirst) {
  const ScratchFolder folder;
  const std::string file = folder / "run.mcap";
  const std::string whole = folder / "whole.mcap";
  const Bytes bytes = test::small_recording(20);
  const Bytes part(bytes.begin(), bytes.end() - 30);
  test::write_bytes(file, part);
  const Ended ended = recover({file, "-o", whole});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(test::read_bytes(file), part);
  EXPECT_EQ(McapReader(whole).statistics().message_count, 20U);
}

void expect_not_recovered(const std::vector<std::string>& arguments, const std::string& reason) {
  const Ended ended = recover(arguments);
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_NE(ended.err.find(reason), std::string::npos) << ended.err;
  EXPECT_EQ(ended.out, "");
}

TEST(RecoverCommand, RejectsFilesThatItCannotReadOrWrite) {
  const ScratchFolder folder;
  expect_not_recovered({folder / "none.mcap"}, "cannot be read: No such file or directory");
  write_file(folder / "text.mcap", "something else");
  expect_not_recovered({folder / "text.mcap"}, "text.mcap: byte 0: this is not an MCAP file");
  const std::string file = folder / "run.mcap";
  test::write_bytes(file, test::small_recording(3));
  expect_not_recovered({file, "-o", folder / "no_folder/run.mcap"}, "cannot be written to");
  recording::DiskFile being_recorded(file);
  being_recorded.write(test::small_recording(3));
  expect_not_recovered({file}, "another process is recording to it");
}

// Header and attachments are complete, and the only chunk is truncated.
TEST(RecoverCommand, DoesNotReplaceAFileByOneWithoutMessages) {
  const ScratchFolder folder;
  const std::string file = folder / "run.mcap";
  const Bytes bytes = test::small_recording(4);
  test::write_bytes(file, bytes);
  const std::uint64_t chunk = McapReader(file).blocks().front().offset;
  for (const std::uint64_t size : {std::uint64_t{41}, chunk - 1, chunk + 30}) {
    SCOPED_TRACE(size);
    const Bytes part(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    test::write_bytes(file, part);
    expect_not_recovered({file}, "no message in the file can be read");
    EXPECT_EQ(test::read_bytes(file), part);
  }
  expect_not_recovered({file}, "only 1 attachment and 0 records of metadata, which '-o' writes to another file");
  EXPECT_EQ(recover({file, "-o", folder / "rest.mcap"}).exit_code, 0);
  EXPECT_EQ(McapReader(folder / "rest.mcap").attachments().size(), 1U);
}

TEST(AStuckTick, IsReportedAlsoWithQuiet) {
  const SmallExperiment experiment(test_controller("misbehaving"));
  Process run(experiment.run({"--controllers", "inprocess", "--quiet"}), {{"COHORT_TEST_FAULT", "loop"}});
  EXPECT_TRUE(run.wait_for_output("cohort: warning: tick 20: the controller '" + test_controller("misbehaving") +
                                  "' of r0 (team pair) has not returned from step for 10 s"))
      << run.output();
  EXPECT_TRUE(run.wait_for_output("'deadline: 1, on_late: hold'")) << run.output();
  EXPECT_TRUE(run.running()) << "it waits";
}

// The recorded data are in the file, although it was not closed.
TEST(AStuckTick, EndsTheProcessWithAMessageAfterATimeout) {
  const ScratchFolder folder;
  const std::string file = folder / "run.mcap";
  const SmallExperiment experiment(test_controller("misbehaving"));
  Process run(experiment.run({"--controllers", "inprocess", "--record", file}), {{"COHORT_TEST_FAULT", "loop"}});
  ASSERT_TRUE(run.wait_for_output("stuck")) << run.output();
  EXPECT_TRUE(eventually([&] { return McapReader(file).statistics().message_count > 20; }));
  run.signal(SIGTERM);
  EXPECT_EQ(run.wait_for_exit(), 1) << run.output();
  EXPECT_NE(run.output().find("tick 20 has not ended 10 s after the request to stop: the controller '" +
                              test_controller("misbehaving") + "' of r0 (team pair) has not returned from step."),
            std::string::npos)
      << run.output();
  EXPECT_EQ(recover({file}).exit_code, 0);
  EXPECT_TRUE(McapReader(file).is_complete());
}

}  // namespace
}  // namespace cohort::test
