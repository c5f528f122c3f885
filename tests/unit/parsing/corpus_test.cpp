// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "server/core/text.hpp"
#include "server/description/experiment.hpp"
#include "server/description/world.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/parsing/sdf/file_kind.hpp"
#include "server/parsing/world/read_world.hpp"
#include "server/parsing/writing/write_world.hpp"

/// Unusual files in SDF, URDF, YAML and experiments: those in tests/data/corpus/valid are accepted, and each in broken/
/// is rejected with the message in FILE.expected. For some in valid/, FILE.expected says what they mean: parts of the
/// exported world, and of each warning.
namespace cohort::description {

namespace {

namespace fs = std::filesystem;

const fs::path corpus = COHORT_SOURCE_DIR "/tests/data/corpus";

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() != ".expected") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<fs::path> files_with_meaning() {
  std::vector<fs::path> files = files_in(corpus / "valid");
  std::erase_if(files, [](const fs::path& file) { return !fs::exists(file.string() + ".expected"); });
  return files;
}

void read(const fs::path& file) {
  if (parsing::kind_of_file(file) == parsing::FileKind::sdf)
    parsing::read_world_or_model(file, 1);
  else
    parsing::read_experiment(file);
}

std::string name_of_test(const ::testing::TestParamInfo<fs::path>& info) {
  std::string name = info.param.filename().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '.'; }, '_');
  return name;
}

class ValidFile : public ::testing::TestWithParam<fs::path> {};

TEST_P(ValidFile, IsRead) { EXPECT_NO_THROW(read(GetParam())); }

INSTANTIATE_TEST_SUITE_P(Corpus, ValidFile, ::testing::ValuesIn(files_in(corpus / "valid")), name_of_test);

std::string with_single_spaces(const std::string& text) {
  std::string single;
  for (const std::string_view word : words(text)) single += (single.empty() ? "" : " ") + std::string(word);
  return single;
}

class FileWithMeaning : public ::testing::TestWithParam<fs::path> {};

// Each line of the file is a part of the exported world, without line breaks, or `warning: ` and a part of a warning.
TEST_P(FileWithMeaning, IsWhatIsExpected) {
  const World world = parsing::read_world_or_model(GetParam(), 1);
  const std::string exported = with_single_spaces(parsing::xml_text(parsing::sdf_of(world, GetParam().parent_path())));
  std::vector<std::string> warnings;
  for (const Problem& warning : world.warnings) warnings.push_back(warning.text());
  std::ifstream stream(GetParam().string() + ".expected");
  for (std::string line; std::getline(stream, line);) {
    constexpr std::string_view mark = "warning: ";
    if (!line.starts_with(mark)) {
      EXPECT_NE(exported.find(line), std::string::npos) << line << "\nis not in\n" << exported;
      continue;
    }
    const auto found = std::ranges::find_if(warnings, [&](const std::string& warning) {
      return warning.find(line.substr(mark.size())) != std::string::npos;
    });
    if (found == warnings.end()) ADD_FAILURE() << "no " << line;
    if (found != warnings.end()) warnings.erase(found);
  }
  for (const std::string& warning : warnings) ADD_FAILURE() << "not expected: " << warning;
}

INSTANTIATE_TEST_SUITE_P(Corpus, FileWithMeaning, ::testing::ValuesIn(files_with_meaning()), name_of_test);

class BrokenFile : public ::testing::TestWithParam<fs::path> {};

// `LINE: PART OF THE MESSAGE`, or the part alone; line 0 is none.
TEST_P(BrokenFile, IsRejectedWithPositionAndReason) {
  std::ifstream stream(GetParam().string() + ".expected");
  std::string expected;
  ASSERT_TRUE(std::getline(stream, expected)) << "there is no " << GetParam().filename() << ".expected";
  std::string place;
  if (const std::size_t colon = expected.find(": "); colon <= 3 && expected[0] >= '0' && expected[0] <= '9') {
    place = GetParam().filename().string() + (expected[0] == '0' ? ": " : ":" + expected.substr(0, colon) + ": ");
    expected.erase(0, colon + 2);
  }
  try {
    read(GetParam());
    FAIL() << "it was read";
  } catch (const InputError& error) {
    const bool found = std::any_of(error.problems().begin(), error.problems().end(), [&](const Problem& problem) {
      const std::string text = problem.text();
      return text.find(place) != std::string::npos && text.find(expected) != std::string::npos;
    });
    EXPECT_TRUE(found) << "expected " << place << expected << "\ngot      " << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(Corpus, BrokenFile, ::testing::ValuesIn(files_in(corpus / "broken")), name_of_test);

}  // namespace
}  // namespace cohort::description
