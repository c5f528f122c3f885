// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/pages.hpp"

// Compares the sources with the lists of folders in docs/architecture.md.
namespace cohort {
namespace {

using Names = std::set<std::string>;
using Graph = std::map<std::string, Names>;

std::vector<std::string> matches_in(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
    found.push_back((*match)[1]);
  return found;
}

struct Folder {
  Names includes;
  std::string libraries;
};

// By path. An item of the page is: - `path/`: the folder's job. Includes: `a`, `b`. Libraries: c, d.
std::map<std::string, Folder> read_folders() {
  std::map<std::string, Folder> folders;
  const std::regex pattern(R"(- `([\w/]+)/`: (.*?)( Includes: ([^:]*)\.)?( Libraries: ([^:]*)\.)?)");
  for (const std::string& item : test::list_items_of(COHORT_SOURCE_DIR "/docs/architecture.md")) {
    std::smatch parts;
    if (!std::regex_match(item, parts, pattern)) continue;
    Folder& folder = folders[parts[1]];
    folder.libraries = parts[6];
    for (const std::string& name : matches_in(parts[4], std::regex("`([\\w/]+)`")))
      folder.includes.insert(std::filesystem::exists(COHORT_SOURCE_DIR "/server/" + name) ? "server/" + name : name);
  }
  return folders;
}

struct Source {
  std::string path;  // from the top
  std::string folder;
  Names files;    // our files that it includes
  Names headers;  // other headers
};

const std::vector<std::string> public_headers = {"client_sdk/include/", "idl/include/"};

// Returns the file of a public header `cohort/…`.
std::string public_header(const std::string& header) {
  for (const std::string& folder : public_headers)
    if (std::filesystem::exists(COHORT_SOURCE_DIR "/" + folder + header)) return folder + header;
  return public_headers.front() + header;
}

// Notes the includes of a file of this text; `is_beside` says whether a file is in its folder.
template <class IsBeside>
void note_includes(Source& source, const std::string& text, const IsBeside& is_beside) {
  for (const std::string& file : matches_in("\n" + text, std::regex("\n[ \t]*#[ \t]*include[ \t]*\"([^\"]+)\""))) {
    const std::filesystem::path named = is_beside(file) ? source.folder + "/" + file : file;
    if (named != "idl/cohort.h") source.files.insert(named.lexically_normal());  // which the IDL compiler makes
  }
  for (const std::string& header : matches_in("\n" + text, std::regex("\n[ \t]*#[ \t]*include[ \t]*<([^>]+)>"))) {
    if (header.starts_with("cohort/"))
      source.files.insert(public_header(header));
    else
      source.headers.insert(header);
  }
}

std::vector<Source> read_sources() {
  const std::filesystem::path top = COHORT_SOURCE_DIR;
  const Names endings = {".cpp", ".hpp", ".h", ".c"};
  std::vector<Source> sources;
  for (const char* const part : {"idl", "client_sdk", "server", "tools", "tests/benchmarks/comparison"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(top / part)) {
      if (!endings.contains(entry.path().extension())) continue;
      const std::filesystem::path path = entry.path().lexically_relative(top);
      Source source{path, path.parent_path(), {}, {}};
      std::stringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      note_includes(source, text.str(), [&](const std::string& file) {
        return std::filesystem::exists(entry.path().parent_path() / file);
      });
      sources.push_back(std::move(source));
    }
  return sources;
}

std::string folder_of(const std::string& file) { return std::filesystem::path(file).parent_path(); }

// One that leads back to where it began, as `a > b > a`; empty if there is none.
std::string circle_in(const Graph& graph) {
  std::set<std::string> done;
  std::vector<std::string> way;
  std::string found;
  const auto visit = [&](const auto& self, const std::string& node) -> void {
    if (!found.empty() || done.contains(node)) return;
    if (const auto before = std::ranges::find(way, node); before != way.end()) {
      for (auto each = before; each != way.end(); ++each) found += *each + " > ";
      found += node;
      return;
    }
    way.push_back(node);
    if (const auto next = graph.find(node); next != graph.end())
      for (const std::string& each : next->second) self(self, each);
    way.pop_back();
    done.insert(node);
  };
  for (const auto& [node, next] : graph) visit(visit, node);
  return found;
}

TEST(Architecture, EveryFolderIsListedAndIncludesWhatItNamesAndNothingElse) {
  const std::map<std::string, Folder> folders = read_folders();
  ASSERT_GT(folders.size(), 40u);
  std::map<std::string, Names> used;
  for (const Source& source : read_sources()) {
    const auto listed = folders.find(source.folder);
    if (listed == folders.end()) {
      ADD_FAILURE() << source.folder << " is not listed in docs/architecture.md";
      continue;
    }
    used[source.folder];
    for (const std::string& file : source.files) {
      EXPECT_TRUE(std::filesystem::exists(COHORT_SOURCE_DIR "/" + file)) << source.path << " includes " << file;
      const std::string folder = folder_of(file);
      if (folder == source.folder) continue;
      used[source.folder].insert(folder);
      EXPECT_TRUE(listed->second.includes.contains(folder))
          << source.path << " includes " << file << ", which is not listed for " << source.folder;
    }
  }
  for (const auto& [folder, listed] : folders) {
    EXPECT_TRUE(used.contains(folder)) << folder << " is listed and has no sources";
    for (const std::string& named : listed.includes)
      EXPECT_TRUE(used[folder].contains(named))
          << folder << " does not include " << named << ", which is listed for it";
  }
}

TEST(Architecture, TheTopLevelFoldersIncludeOnlyThoseBefore) {
  const std::vector<std::string> order = {"idl", "client_sdk", "server", "tools", "tests"};
  const auto place_of = [&](const std::string& file) {
    return std::ranges::find(order, std::filesystem::path(file).begin()->string()) - order.begin();
  };
  for (const Source& source : read_sources())
    for (const std::string& file : source.files)
      EXPECT_LE(place_of(file), place_of(source.path)) << source.path << " includes " << file;
}

TEST(Architecture, BridgesIncludeOnlyPublicHeadersOfTheSdk) {
  std::size_t includes = 0;
  for (const Source& source : read_sources()) {
    if (!source.path.starts_with("tools/bridges/")) continue;
    for (const std::string& file : source.files) {
      if (!file.starts_with("client_sdk/")) continue;
      ++includes;
      EXPECT_TRUE(file.starts_with("client_sdk/include/")) << source.path << " includes " << file;
    }
  }
  EXPECT_GT(includes, 10u);
}

// As the includes, the imports of the page: `from "./name"`.
TEST(Architecture, ModulesOfThePageImportEachOtherInNoCircle) {
  const std::filesystem::path top = COHORT_SOURCE_DIR "/tools/view/page/src";
  Graph modules;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(top)) {
    if (entry.path().extension() != ".ts") continue;
    std::stringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    Names& imported = modules[entry.path().lexically_relative(top).replace_extension()];
    for (const std::string& name : matches_in(text.str(), std::regex("from \"(\\.[^\"]+)\"")))
      imported.insert((entry.path().parent_path() / name).lexically_normal().lexically_relative(top));
  }
  ASSERT_TRUE(modules["main"].contains("data/connection"));
  EXPECT_EQ(circle_in(modules), "");
}

TEST(Architecture, EveryIncludeIsSeenWhereverItStands) {
  Source source{"server/core/a.cpp", "server/core", {}, {}};
  note_includes(source,
                "#include \"server/physics/first.hpp\"\n#pragma once\n  #  include <cohort/controller.hpp>\n"
                "#if X\n\t#include <btBulletCollisionCommon.h>\n#endif\n#include \"beside.hpp\"\n",
                [](const std::string& file) { return file == "beside.hpp"; });
  EXPECT_EQ(source.files,
            (Names{"server/physics/first.hpp", "client_sdk/include/cohort/controller.hpp", "server/core/beside.hpp"}));
  EXPECT_EQ(source.headers, Names{"btBulletCollisionCommon.h"});
}

TEST(Architecture, NeitherFoldersNorFilesIncludeEachOtherInACircle) {
  Graph folders, files;
  for (const Source& source : read_sources()) {
    files[source.path] = source.files;
    for (const std::string& file : source.files)
      if (folder_of(file) != source.folder) folders[source.folder].insert(folder_of(file));
  }
  EXPECT_EQ(circle_in(folders), "");
  EXPECT_EQ(circle_in(files), "");
  EXPECT_EQ(circle_in({{"a", {"b"}}, {"b", {"c"}}, {"c", {"b"}}}), "b > c > b");
}

// A module is a header and the sources of its name.
TEST(Architecture, ModulesNeedEachOtherInNoCircle) {
  const auto module_of = [](const std::string& file) { return std::filesystem::path(file).replace_extension(); };
  Graph modules;
  for (const Source& source : read_sources())
    for (const std::string& file : source.files)
      if (module_of(file) != module_of(source.path)) modules[module_of(source.path)].insert(module_of(file));
  EXPECT_GT(modules.size(), 500u);
  EXPECT_EQ(circle_in(modules), "");
}

TEST(Architecture, EachLibraryIsIncludedWhereItIsListed) {
  const std::vector<std::pair<std::string, std::regex>> libraries = {
      {"Cyclone DDS", std::regex("dds/.*")},
      {"Fast DDS", std::regex("(fastdds|fastrtps)/.*")},
      {"oneTBB", std::regex("tbb/.*")},
      {"Random123", std::regex("Random123/.*")},
      {"libsdformat", std::regex("(sdf|ignition|console_bridge)/.*")},
      {"yaml-cpp", std::regex("yaml-cpp/.*")},
      {"expat", std::regex("expat\\.h")},
      {"Assimp", std::regex("assimp/.*")},
      {"libpng", std::regex("png\\.h")},
      {"Bullet", std::regex("(bt|Bullet|LinearMath).*")},
      {"RE2", std::regex("re2/.*")},
      {"zstd", std::regex("zstd\\.h")},
      {"zlib", std::regex("zlib\\.h")},
      {"OpenSSL", std::regex("openssl/.*")},
      {"hdf5", std::regex("hdf5\\.h")},
      {"Boost.Beast", std::regex("boost/(beast|asio).*")},
      {"Boost.CRC", std::regex("boost/crc.*")},
      {"ODE", std::regex("ode/.*")},
      {"MuJoCo", std::regex("mujoco/.*")},
      {"Enki", std::regex("enki/.*")},
      {"CLI11", std::regex("CLI/.*")},
      {"spdlog", std::regex("spdlog/.*")},
      {"nlohmann-json", std::regex("nlohmann/.*")},
      {"nanobind", std::regex("nanobind/.*")},
      {"simavr", std::regex("(sim_avr|avr_[a-z]+)\\.h")},
      {"Python", std::regex("Python\\.h")},
  };
  // Headers of the system and of the language, and those that any folder may include.
  const std::regex others(
      "[a-z_]+|(std|sys|net|netinet|arpa|linux)[a-z]*/"
      ".*|(std[a-z]+|inttypes|dlfcn|elf|link|fcntl|ifaddrs|netdb|poll|pthread|spawn|"
      "termios|unistd|aio|mqueue|math|string|signal|fenv|time|errno|sched|semaphore|threads)\\.h|Eigen/.*|fmt/"
      ".*|cohort\\.h|cohort_build/"
      ".*|cxxabi\\.h|"
      "immintrin\\.h|x86intrin\\.h|execinfo\\.h");
  const std::map<std::string, Folder> folders = read_folders();
  Names seen;
  for (const Source& source : read_sources())
    for (const std::string& header : source.headers) {
      const auto library =
          std::ranges::find_if(libraries, [&](const auto& each) { return std::regex_match(header, each.second); });
      if (library == libraries.end()) {
        EXPECT_TRUE(std::regex_match(header, others))
            << source.path << " includes <" << header << ">, a header of no library in the list of this test";
        continue;
      }
      seen.insert(library->first);
      const auto listed = folders.find(source.folder);
      const bool is_here =
          listed != folders.end() && listed->second.libraries.find(library->first) != std::string::npos;
      EXPECT_TRUE(is_here) << source.path << " includes <" << header << ">, which is not listed with the library "
                           << library->first;
    }
  EXPECT_GT(seen.size(), 14u);
}

// A stage is a folder of server/. Its files may include the same stages that it links.
TEST(Architecture, EachStageLinksOnlyStagesThatItsFoldersInclude) {
  const auto stage_of = [](const std::string& folder) {
    const std::regex pattern("server/([a-z_]+).*");
    std::smatch name;
    return std::regex_match(folder, name, pattern) ? name[1].str() : std::string();
  };
  Graph named;
  for (const auto& [folder, listed] : read_folders())
    for (const std::string& other : listed.includes) named[stage_of(folder)].insert(stage_of(other));
  std::stringstream text;
  text << std::ifstream(COHORT_SOURCE_DIR "/server/CMakeLists.txt").rdbuf();
  std::size_t stages = 0;
  for (const std::string& arguments : matches_in(text.str(), std::regex("\ncohort_stage\\(([^)]*)\\)"))) {
    const std::string stage = arguments.substr(0, arguments.find(' '));
    ++stages;
    for (const std::string& linked : matches_in(arguments, std::regex("cohort_([a-z_]+)")))
      if (std::filesystem::exists(COHORT_SOURCE_DIR "/server/" + linked)) {
        EXPECT_TRUE(named[stage].contains(linked))
            << "server/" << stage << " links server/" << linked << ", which no folder of server/" << stage
            << " is listed to include";
      }
  }
  EXPECT_GT(stages, 14u);
}

TEST(Architecture, NoTwoHeadersHaveTheSameName) {
  std::map<std::string, std::string> paths;
  for (const Source& source : read_sources()) {
    const std::filesystem::path path = source.path;
    if (path.extension() == ".cpp" || path.extension() == ".c") continue;
    const auto is_public = [&](const std::string& folder) { return source.path.starts_with(folder); };
    if (std::ranges::any_of(public_headers, is_public)) continue;  // <cohort/...> tells them apart
    const auto [found, is_new] = paths.emplace(path.stem(), source.path);
    EXPECT_TRUE(is_new) << source.path << " and " << found->second;
  }
}

std::string text_of(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(COHORT_SOURCE_DIR "/" + path).rdbuf();
  return text.str();
}

// Those of the register in description/devices.hpp.
Names device_kinds() {
  const std::string text = text_of("server/description/devices.hpp");
  const std::size_t begin = text.find("using DeviceKinds");
  const std::vector<std::string> words =
      matches_in(text.substr(begin, text.find(';', begin) - begin), std::regex("([A-Z]\\w+)[,>]"));
  return {words.begin(), words.end()};
}

// The device kinds that code names, in neither comments nor strings.
Names kinds_named_in(std::string code, const Names& kinds) {
  code = std::regex_replace(code, std::regex("//[^\n]*|\"(\\\\.|[^\"\\\\\n])*\""), " ");
  Names named;
  for (const std::string& word : matches_in(code, std::regex("\\b([A-Z]\\w+)\\b")))
    if (kinds.contains(word)) named.insert(word);
  return named;
}

// Other code asks for general properties of a device (description/device_properties.hpp). So a new kind is a struct in
// description/, a reader in parsing/, one file in sensing/ or actuation/, and a message in messages/.
TEST(Architecture, ConcreteKindsOfDevicesAreNamedWhereTheyAreDescribedReadSensedMovedAndSentAlone) {
  const Names kinds = device_kinds();
  ASSERT_GT(kinds.size(), 30u);
  const Names homes = {"description", "parsing", "sensing", "actuation", "messages"};
  std::map<std::string, Names> exceptions = {
      // The gripper's function, on which its actuator and its sensor build.
      {"server/gripping/grippers.cpp", {"Gripper"}},
      {"server/gripping/grippers.hpp", {"Gripper"}},
      // A model of any kind of motor, whose bits tell builds apart.
      {"server/simulation/build_identity.cpp", {"VelocityMotor"}},
      // Viewers draw the rays of some sensors; one of another kind is not drawn, but for its channels.
      {"server/viewing/scene_models.cpp", {"GroundSensors", "Lidar", "LightSensors", "ProximityRing"}},
  };
  for (const Source& source : read_sources()) {
    if (!source.path.starts_with("server/")) continue;
    const std::filesystem::path within = std::filesystem::path(source.path).lexically_relative("server");
    if (homes.contains(*within.begin())) continue;
    const auto exception = exceptions.find(source.path);
    for (const std::string& kind : kinds_named_in(text_of(source.path), kinds)) {
      const bool is_excepted = exception != exceptions.end() && exception->second.erase(kind) == 1;
      EXPECT_TRUE(is_excepted) << source.path << " names the device kind " << kind
                               << "; expected a property of devices in its place";
    }
  }
  for (const auto& [path, unused] : exceptions)
    for (const std::string& kind : unused)
      ADD_FAILURE() << path << " does not name " << kind << "; expected no exception for it";
}

TEST(Architecture, ADeviceKindIsNotNamedByACommentOrAString) {
  EXPECT_EQ(kinds_named_in("// Belt\nstd::get_if<description::Rotor>(&x); \"a \\\" Lidar\" Belts TreelDrive;",
                           {"Belt", "Rotor", "Lidar", "TreelDrive"}),
            (Names{"Rotor", "TreelDrive"}));
}

TEST(Architecture, EverySourceNamesItsLicense) {
  std::size_t count = 0;
  for (const char* const part : {"idl", "client_sdk", "server", "tools", "tests"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(COHORT_SOURCE_DIR "/" + std::string(part))) {
      const std::string extension = entry.path().extension();
      if (extension != ".cpp" && extension != ".hpp" && extension != ".h" && extension != ".c") continue;
      if (entry.path().string().find("node_modules") != std::string::npos) continue;
      std::ifstream file(entry.path());
      std::string first;
      std::getline(file, first);
      EXPECT_EQ(first, "// SPDX-License-Identifier: Apache-2.0") << entry.path();
      ++count;
    }
  }
  EXPECT_GT(count, 1000u);
}

}  // namespace
}  // namespace cohort
