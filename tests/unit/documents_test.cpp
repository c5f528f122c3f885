#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>

#include "tests/support/files.hpp"

namespace cohort {
namespace {

std::set<std::string> tests_in_the_sources() {
  const std::regex definition(R"(\bTEST(?:_F|_P)?\((\w+),\s*(\w+)\))");
  std::set<std::string> tests;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(COHORT_SOURCE_DIR "/tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string source = test::read_file(entry.path());
    for (std::sregex_iterator match(source.begin(), source.end(), definition), end; match != end; ++match)
      tests.insert((*match)[1].str() + "." + (*match)[2].str());
  }
  return tests;
}

TEST(Documents, TheSemanticsNameTestsThatExistAndEveryLineHasOne) {
  const std::set<std::string> tests = tests_in_the_sources();
  std::ifstream document(COHORT_SOURCE_DIR "/docs/semantics.md");
  const std::regex name(R"(`([A-Z]\w+)\.(\w+|\*)`)");
  int named = 0;
  bool in_lines = true;
  for (std::string line; std::getline(document, line);) {
    if (line.starts_with("## Decided, not built yet")) in_lines = false;
    const bool is_row =
        line.starts_with("| ") && !line.starts_with("| what") && !line.starts_with("| `on_late` | what");
    if (!in_lines || !is_row) continue;
    const std::sregex_iterator first(line.begin(), line.end(), name);
    EXPECT_NE(first, std::sregex_iterator()) << "no test holds this line: " << line;
    for (std::sregex_iterator match = first; match != std::sregex_iterator(); ++match) {
      const std::string suite = (*match)[1], test = (*match)[2];
      const auto found = test == "*" ? tests.lower_bound(suite + ".") : tests.find(suite + "." + test);
      EXPECT_TRUE(found != tests.end() && found->starts_with(suite + ".")) << suite << "." << test << " does not exist";
      ++named;
    }
  }
  EXPECT_GT(named, 40);
}

// Code blocks that begin with the name of a file: each stands in it as it is.
TEST(Documents, ExcerptsStandInTheFilesThatTheyName) {
  const std::regex block(R"(```cpp\n// ([\w.]+/[\w/.]+)\n([\s\S]*?)```)");
  const std::string document = test::read_file(COHORT_SOURCE_DIR "/docs/contributing.md");
  int excerpts = 0;
  for (std::sregex_iterator match(document.begin(), document.end(), block), end; match != end; ++match) {
    const std::string file = (*match)[1], excerpt = (*match)[2];
    EXPECT_NE(test::read_file(std::filesystem::path(COHORT_SOURCE_DIR) / file).find(excerpt), std::string::npos)
        << "contributing.md shows this of " << file << ":\n"
        << excerpt;
    ++excerpts;
  }
  EXPECT_GT(excerpts, 8);
}

}  // namespace
}  // namespace cohort
