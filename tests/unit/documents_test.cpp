// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/support/files.hpp"
#include "tests/support/pages.hpp"

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

TEST(Documents, TheSemanticsNameTestsThatExistAndEveryRuleHasOne) {
  const std::set<std::string> tests = tests_in_the_sources();
  const std::regex name(R"(`([A-Z]\w+)\.(\w+|\*)`)");
  int named = 0;
  for (const std::string& item : test::list_items_of(COHORT_SOURCE_DIR "/docs/semantics.md")) {
    const std::sregex_iterator first(item.begin(), item.end(), name);
    EXPECT_NE(first, std::sregex_iterator()) << "no test holds this rule: " << item;
    for (std::sregex_iterator match = first; match != std::sregex_iterator(); ++match) {
      const std::string suite = (*match)[1], test = (*match)[2];
      const auto found = test == "*" ? tests.lower_bound(suite + ".") : tests.find(suite + "." + test);
      EXPECT_TRUE(found != tests.end() && found->starts_with(suite + ".")) << suite << "." << test << " does not exist";
      ++named;
    }
  }
  EXPECT_GT(named, 200);
}

// A test that was renamed would no longer be long, and would no longer begin early.
TEST(Documents, TheListsOfLongTestsNameSuitesAndTestsThatExist) {
  std::set<std::string> names = {"WithOurOwnDynamics", "Python"};
  for (const std::string& test : tests_in_the_sources()) {
    names.insert(test.substr(0, test.find('.')));
    names.insert(test.substr(test.find('.') + 1));
  }
  // A pattern, and then reasons; or seconds, and then a name. Instances and parameters are left out.
  const std::regex entry(R"(^(?:\d+ )?(?:[^ /.]+/)?([^ /]+))"), word(R"(\b[A-Z]\w{4,})");
  int named = 0;
  for (const char* const list : {"long_tests.txt", "costs.txt"})
    for (const std::string& line : test::lines_of(test::read_file(std::string(COHORT_SOURCE_DIR "/tests/") + list))) {
      std::smatch test;
      if (line.starts_with("#") || !std::regex_search(line, test, entry)) continue;
      const std::string name = test[1];
      for (std::sregex_iterator match(name.begin(), name.end(), word), end; match != end; ++match, ++named) {
        const auto found = names.lower_bound(match->str());  // a pattern may have the beginning of a name
        EXPECT_TRUE(found != names.end() && found->starts_with(match->str()))
            << list << ": " << line << ": " << match->str() << " does not exist";
      }
    }
  EXPECT_GT(named, 60);
}

// Code blocks that begin with the name of a file are verbatim excerpts of it.
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

// As GitHub makes anchors of headings: lower case, without punctuation, with hyphens for spaces.
std::string anchor_of(const std::string& heading) {
  const std::string plain = std::regex_replace(heading, std::regex(R"(\[([^\]]*)\]\([^)]*\)|…|–|—|×|“|”)"), "$1");
  std::string anchor;
  for (const char c : plain) {
    if (c == ' ') anchor += '-';
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || (c & 0x80))
      anchor += static_cast<char>(c & 0x80 ? c : std::tolower(static_cast<unsigned char>(c)));
  }
  return anchor;
}

struct Document {
  std::set<std::string> anchors;
  std::vector<std::string> links;
};

Document read_document(const std::filesystem::path& file) {
  static const std::regex link(R"(\]\(([^)\s]+)\))");
  Document document;
  bool is_code = false;
  for (const std::string& line : test::lines_of(test::read_file(file))) {
    const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
    if (line.compare(begin, 3, "```") == 0) is_code = !is_code;
    if (is_code) continue;
    if (line.starts_with('#')) {
      const std::string anchor = anchor_of(line.substr(std::min(line.find(' '), line.size() - 1) + 1));
      std::string unique = anchor;
      for (int i = 1; !document.anchors.insert(unique).second; ++i) unique = anchor + "-" + std::to_string(i);
    }
    for (std::sregex_iterator match(line.begin(), line.end(), link), end; match != end; ++match)
      document.links.push_back((*match)[1]);
  }
  return document;
}

TEST(Documents, LinkToFilesAndHeadingsThatExist) {
  const std::filesystem::path root = COHORT_SOURCE_DIR;
  std::map<std::filesystem::path, Document> documents;
  documents[root / "README.md"] = read_document(root / "README.md");
  for (const char* const folder : {"docs", "docker", "worlds"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder))
      if (entry.path().extension() == ".md") documents[entry.path()] = read_document(entry.path());
  int followed = 0;
  for (const auto& [file, document] : documents)
    for (const std::string& link : document.links) {
      if (link.find("://") != std::string::npos || link.starts_with("mailto:")) continue;
      const std::size_t hash = std::min(link.find('#'), link.size());
      const std::filesystem::path target =
          hash == 0 ? file : (file.parent_path() / link.substr(0, hash)).lexically_normal();
      EXPECT_TRUE(std::filesystem::exists(target)) << file << " links to " << link << ", which does not exist";
      if (hash < link.size() && documents.contains(target)) {
        EXPECT_TRUE(documents[target].anchors.contains(link.substr(hash + 1)))
            << file << " links to " << link << ", and there is no such heading";
      }
      ++followed;
    }
  EXPECT_GT(followed, 500);
}

struct VersionPlace {
  std::string file;
  std::string pattern;  ///< its group is the version
};

/// Returns everything in these files that the group of the pattern matches.
std::vector<std::string> versions_in(const VersionPlace& place) {
  const std::string text = test::read_file(std::filesystem::path(COHORT_SOURCE_DIR) / place.file);
  const std::regex pattern(place.pattern);
  std::vector<std::string> versions;
  for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
    versions.push_back((*match)[1]);
  return versions;
}

// CMakeLists.txt has the version, and pyproject.toml reads it there.
TEST(Documents, EveryBaseImageIsNamedByItsDigest) {
  const std::string file = test::read_file(COHORT_SOURCE_DIR "/docker/Dockerfile");
  EXPECT_TRUE(std::regex_search(file, std::regex(R"(\nARG BASE=\S+@sha256:[0-9a-f]{64}\n)")));
  const std::regex from(R"(\nFROM (\S+)(?: AS (\w+))?)");
  std::set<std::string> stages = {"${BASE}"};
  for (std::sregex_iterator match(file.begin(), file.end(), from), end; match != end; ++match) {
    EXPECT_TRUE(stages.contains((*match)[1])) << (*match)[1] << " is neither ${BASE} nor a stage";
    stages.insert((*match)[2]);
  }
  EXPECT_GT(stages.size(), 3u);
}

TEST(Documents, NameTheVersionOfTheProject) {
  const std::string image = R"(\bcohort(?:-sdk)?:(\d+\.\d+\.\d+))",
                    package = R"(\bcohort(?:-dev)?_(\d[\w.]*)_amd64\.deb)";
  std::vector<VersionPlace> places = {
      {"CMakeLists.txt", versions_in({"pyproject.toml", "regex = '(.*)\\(\\?P<value>"}).at(0) + "([0-9.]+)"},
      {"idl/cohort_msgs/package.xml", "<version>(.*)</version>"},
      {"idl/include/cohort/version.h", "COHORT_VERSION \"(.*)\""},
      {"CITATION.cff", "\nversion: (.*)"},
      {"CHANGELOG.md", R"(\n## (\d\S*) — )"},
      {"docker/Dockerfile", "image\\.version=\"(.*?)\""},
      {"docs/install.md", package},
  };
  for (const auto& entry : std::filesystem::recursive_directory_iterator(COHORT_SOURCE_DIR "/docker"))
    if (entry.is_regular_file() && test::read_file(entry.path()).find("image: cohort:") != std::string::npos)
      places.push_back({std::filesystem::relative(entry.path(), COHORT_SOURCE_DIR), image});
  EXPECT_GT(places.size(), 10U) << "compose files and manifests name images";
  for (const char* const file : {"docker/Dockerfile", "docker/README.md"}) places.push_back({file, image});
  for (const VersionPlace& place : places) {
    std::vector<std::string> versions = versions_in(place);
    if (place.file == "CHANGELOG.md") versions.resize(std::min<std::size_t>(versions.size(), 1));  // the newest
    EXPECT_FALSE(versions.empty()) << place.file << " names no version: " << place.pattern;
    for (const std::string& version : versions) EXPECT_EQ(version, COHORT_VERSION) << place.file;
  }
  const std::string version = COHORT_VERSION;
  std::string in_numbers;
  for (const char* const part : {"MAJOR", "MINOR", "PATCH"})
    in_numbers +=
        "." + versions_in({"idl/include/cohort/version.h", "COHORT_VERSION_" + std::string(part) + " (\\d+)"}).at(0);
  EXPECT_EQ(in_numbers, "." + version);
  for (const char* const page : {"docs/install.md", "docs/clients.md"})
    for (const std::string& wanted : versions_in({page, R"(find_package\(Cohort (\d+\.\d+))"}))
      EXPECT_EQ(wanted, version.substr(0, version.rfind('.'))) << page;
  EXPECT_EQ(versions_in({"CHANGELOG.md", R"(\n## \d\S* — (.*))"}).at(0),
            versions_in({"CITATION.cff", "\ndate-released: (.*)"}).at(0));
}

}  // namespace
}  // namespace cohort
