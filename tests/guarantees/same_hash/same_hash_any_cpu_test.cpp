// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>

#include "server/description/devices.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/parsing/keys/extensions.hpp"
#include "server/parsing/plugins/gazebo_plugins.hpp"
#include "tests/guarantees/same_hash/names_of_experiments.hpp"
#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

namespace fs = std::filesystem;

// Hides the CPU's fused multiply-add from the C library.
const Process::Environment without_fma = {{"GLIBC_TUNABLES", "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2"}};

const fs::path programs = COHORT_BUILD_DIR "/bin";
const fs::path every_device = COHORT_SOURCE_DIR "/tests/data/every_device";

std::string output_of(const std::vector<std::string>& command, const Process::Environment& environment = {}) {
  const Ended ended = run_to_end(command, environment);
  EXPECT_EQ(ended.exit_code, 0) << command[0] << ": " << ended.err;
  return ended.out;
}

TEST(SameHashAnyCpu, TheCLibraryWithAndWithoutFmaGivesTheSameBits) {
  const std::string sines = programs / "print_sines";
  if (output_of({sines}) == output_of({sines}, without_fma))
    GTEST_SKIP() << "this CPU or C library has only one variant of sin, cos and atan2";

  const auto summary = run_demo({"--controllers", "inprocess", "--duration", "10"}, without_fma);
  EXPECT_EQ(summary["state_hash"], reference_hash(10));
}

// Returns the output of `step_world`, which drives every actuator.
std::string driven(const fs::path& experiment, int ticks, const Process::Environment& environment = {}) {
  return output_of({programs / "step_world", experiment, "0", std::to_string(ticks)}, environment);
}

class ShippedExperiments : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedExperiments, GiveTheSameHashWithAndWithoutFma) {
  const fs::path experiment = COHORT_SOURCE_DIR "/worlds/experiments/" + GetParam() + ".yaml";
  if (read_file(experiment).find("controller: keyboard") != std::string::npos) {
    EXPECT_EQ(driven(experiment, 100), driven(experiment, 100, without_fma)) << "people drive it";
    return;
  }
  const std::vector<std::string> arguments = {"--controllers", "inprocess", "--duration", "1"};
  EXPECT_EQ(run_experiment(experiment, arguments)["state_hash"],
            run_experiment(experiment, arguments, without_fma)["state_hash"]);
}

INSTANTIATE_TEST_SUITE_P(SameHashAnyCpu, ShippedExperiments, ::testing::ValuesIn(names_of_experiments()),
                         [](const auto& experiment) { return experiment.param; });

TEST(SameHashAnyCpu, OfAWorldWithEveryDeviceAndEveryPlugin) {
  const fs::path experiment = every_device / "experiment.yaml";
  for (const int ticks : {1, 200}) EXPECT_EQ(driven(experiment, ticks), driven(experiment, ticks, without_fma));
}

TEST(SameHashAnyCpu, TheWorldWithEveryDeviceLacksNone) {
  const description::World world = parsing::read_experiment(every_device / "experiment.yaml").world;
  EXPECT_TRUE(world.warnings.empty()) << world.warnings[0].text();
  std::set<std::size_t> kinds;
  for (const description::Model& model : world.models)
    for (const description::Device& device : model.devices) kinds.insert(device.index());
  for (std::size_t kind = 0; kind < std::variant_size_v<description::DeviceKinds>; ++kind)
    EXPECT_TRUE(kinds.contains(kind)) << "no device of kind " << kind << " of description::DeviceKinds";

  const std::string text = read_file(every_device / "world.yaml");
  const auto expect = [&](const std::string& word) {
    EXPECT_NE(text.find(word), std::string::npos) << every_device / "world.yaml"
                                                  << " has no " << word;
  };
  const std::set<std::string_view> places = {"model", "link", "collision", "joint", "heightmap", "world"};
  for (const parsing::Extension& extension : parsing::extensions()) {
    if (!places.contains(extension.parent) || extension.topic == "placement") continue;
    expect(parsing::prefixed(extension.name) + ":");
    for (const parsing::ExtensionKey& key : extension.keys)
      if (key.name == "technique")
        for (const std::string_view choice : key.choices)
          if (choice != key.fallback) expect("technique: " + std::string(choice));
  }
  for (const parsing::PluginKind& kind : parsing::plugin_kinds())
    if (kind.in_model != nullptr || kind.in_world != nullptr) expect("systems::" + std::string(kind.name) + ",");
}

// Returns the names that `nm` lists, without their versions.
std::set<std::string> symbols(const fs::path& file, const std::string& which) {
  std::istringstream lines(output_of({"nm", "-D", "--format=posix", which, file}));
  std::set<std::string> names;
  for (std::string line; std::getline(lines, line);) names.insert(line.substr(0, line.find_first_of(" @")));
  return names;
}

// Returns the libraries that the dynamic linker loads with a program or a plugin.
std::set<fs::path> libraries_of(const fs::path& file) {
  const std::string text = output_of({"ldd", file});
  const std::regex path("=> (/\\S+)");
  std::set<fs::path> libraries;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), path); it != std::sregex_iterator(); ++it)
    libraries.insert((*it)[1].str());
  return libraries;
}

fs::path c_library_of(const fs::path& program) {
  for (const fs::path& library : libraries_of(program))
    if (library.filename().string().starts_with("libm.so")) return library;
  return {};
}

// Returns true for functions of libm with an exact result, for which every correct implementation gives the same bits.
// Names that end with f are for float, with l for long double.
bool is_exact(std::string name) {
  static const std::set<std::string> exact = {
      "sqrt",         "fabs",       "floor",      "ceil",       "trunc",         "round",        "roundeven",
      "rint",         "nearbyint",  "lround",     "llround",    "lrint",         "llrint",       "fmod",
      "remainder",    "remquo",     "copysign",   "nextafter",  "ldexp",         "scalbn",       "scalbln",
      "frexp",        "modf",       "logb",       "ilogb",      "fmin",          "fmax",         "fdim",
      "fma",          "nan",        "fegetround", "fesetround", "feclearexcept", "fetestexcept", "feraiseexcept",
      "feholdexcept", "feupdateenv"};
  if (exact.contains(name)) return true;
  if (name.ends_with('f') || name.ends_with('l')) name.pop_back();
  return exact.contains(name);
}

// Returns the calls of a file to CPU-dependent functions of the C library's mathematics, except those in `has`.
std::vector<std::string> foreign_calls(const fs::path& file, const std::set<std::string>& c_library,
                                       const std::set<std::string>& has) {
  std::vector<std::string> calls;
  for (const std::string& name : symbols(file, "--undefined-only"))
    if (c_library.contains(name) && !is_exact(name) && !has.contains(name)) calls.push_back(name);
  return calls;
}

// Returns true for the C library's mathematics.
bool is_mathematics(const fs::path& library) { return library.filename().string().starts_with("libm.so"); }

class NonPortableMath : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!is_installed("nm") || !is_installed("ldd")) GTEST_SKIP() << "needs nm and ldd";
    c_library_ = symbols(c_library_of(cohort_program()), "--defined-only");
    ASSERT_TRUE(c_library_.contains("pow"));
  }
  void expect_none(const fs::path& file, const std::set<std::string>& has = {}) const {
    EXPECT_EQ(foreign_calls(file, c_library_, has), std::vector<std::string>{})
        << file << " calls these of the C library; client_sdk/math/ has to have them";
  }
  std::set<std::string> c_library_;
};

TEST_F(NonPortableMath, IsNotCalledByASimulatingProgramOrItsLibraries) {
  for (const char* const name : {"cohort", "cohort-whole"}) {
    const fs::path program = programs / name;
    if (!fs::exists(program)) continue;
    expect_none(program);
    const std::set<std::string> ours = symbols(program, "--defined-only");
    for (const fs::path& library : libraries_of(program))
      if (!is_mathematics(library)) expect_none(library, ours);
  }
}

TEST_F(NonPortableMath, IsNotCalledByAController) {
  int controllers = 0;
  for (const auto& entry : fs::directory_iterator(COHORT_BUILD_DIR "/lib/controllers")) {
    expect_none(entry.path());
    if (const fs::path program = programs / entry.path().stem(); fs::exists(program)) expect_none(program);
    ++controllers;
  }
  EXPECT_GE(controllers, 1);
}

}  // namespace
}  // namespace cohort::test
