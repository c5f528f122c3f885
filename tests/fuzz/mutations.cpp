// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/fuzz_file.hpp"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it so.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;
using Random = std::mt19937_64;  // the same everywhere, as its distributions are not

std::size_t below(std::size_t count, Random& random) { return count == 0 ? 0 : random() % count; }

// The extensions have points between them: sdf, or yaml.yml.
std::vector<std::string> read_corpus(const fs::path& folder, const std::string& extensions) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string() + ".";
    if (entry.is_regular_file() && extension.size() > 2 &&
        ("." + extensions + ".").find(extension) != std::string::npos)
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> texts;
  for (const fs::path& file : files) {
    std::ifstream stream(file, std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return texts;
}

// A few changes to a text, with pieces of another.
std::string mutated(std::string text, const std::string& other, Random& random) {
  constexpr const char* words[] = {"<",  ">",   "/>",   "\"",     ":",    "- ",    "{",   "}",   "[",
                                   "]",  "&a ", "*a",   "0",      "-1",   "1e308", "nan", "inf", "\n",
                                   "  ", "::",  "true", "</sdf>", "\xff", "&#0;",  "''"};
  const std::size_t changes = 1 + below(4, random);
  for (std::size_t i = 0; i < changes; ++i) {
    const std::size_t at = below(text.size() + 1, random);
    const std::size_t length = std::min(text.size() - at, below(20, random));
    switch (below(7, random)) {
      case 0: text.erase(at, length); break;
      case 1: text.insert(at, words[below(std::size(words), random)]); break;
      case 2: text.replace(at, length, words[below(std::size(words), random)]); break;
      case 3: text.insert(at, text.substr(at, length)); break;
      case 4: text.insert(at, other.substr(below(other.size() + 1, random), below(80, random))); break;
      case 5: text.resize(at); break;
      default:
        if (at < text.size()) text[at] = static_cast<char>(random());
    }
  }
  return text;
}

void run(const std::string& text) {
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

}  // namespace

/// Reads every file of the corpus that has one of the extensions, and mutations of them.
int main(int argc, char** argv) {
  if (argc < 4) {
    std::cerr << "usage: " << argv[0] << " EXTENSIONS COUNT CORPUS [SEED]\n";
    return 2;
  }
  const std::vector<std::string> corpus = read_corpus(argv[3], argv[1]);
  if (corpus.empty()) {
    std::cerr << "no such files in " << argv[3] << "\n";
    return 2;
  }
  for (const std::string& text : corpus) run(text);
  Random random(argc > 4 ? std::strtoull(argv[4], nullptr, 10) : 1);
  const std::size_t count = std::strtoull(argv[2], nullptr, 10);
  for (std::size_t i = 0; i < count; ++i)
    run(mutated(corpus[below(corpus.size(), random)], corpus[below(corpus.size(), random)], random));
  std::cout << corpus.size() << " files and " << count << " mutations: no crash\n";
  return 0;
}
