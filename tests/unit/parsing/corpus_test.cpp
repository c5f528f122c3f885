#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>
#include <vector>

#include "server/description/experiment.hpp"
#include "server/description/world.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/parsing/sdf/file_kind.hpp"
#include "server/parsing/world/read_world.hpp"

/// Unusual files in SDF, URDF, YAML and experiments: those in tests/data/corpus/valid are accepted, and each in broken/
/// is rejected with the message in FILE.expected.
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
