// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/viewing/check_scene.hpp"
#include "server/viewing/scene_maker.hpp"
#include "tests/fuzz/edits.hpp"
#include "tests/support/images.hpp"

namespace {

using namespace cohort;

constexpr std::size_t links_of_scene = 100;  // any number

struct Encoded {
  messages::Bytes scene, frame, signals, contacts, robot;
};

Encoded encoded() {
  const auto experiment = parsing::read_experiment(COHORT_SOURCE_DIR "/worlds/experiments/retrieval.yaml");
  Simulation simulation(experiment, 1);
  simulation.step();
  const viewing::SceneMaker maker(simulation, 1);
  messages::Scene scene = maker.scene();
  const std::string image = test::png_of(2, 2);
  scene.textures.push_back({{image.begin(), image.end()}});
  scene.meshes.push_back({{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}});
  scene.mesh_textures.push_back({static_cast<std::uint32_t>(scene.meshes.size() - 1), {0, 0, 1, 0, 0, 1}, {0}});
  scene.shape_textures.push_back({0, 0, 0, 0});
  return {messages::encode(scene), messages::encode(maker.frame(1, 2)), messages::encode(maker.signals()),
          messages::encode(maker.contacts()), messages::encode(maker.robot(0))};
}

template <class Message, class Check>
void decode_any(const messages::Bytes& bytes, std::span<const std::uint8_t> input, Check&& check) {
  const messages::Bytes changed = fuzz::edited(bytes, input);
  try {
    check(messages::decode<Message>(changed));
  } catch (const messages::CdrError&) {
  }
}

}  // namespace

/// Scenes that came over a network are sound, or refused with CdrError.
// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it so.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Encoded whole = encoded();
  const std::span<const std::uint8_t> input(data, size);
  decode_any<messages::Scene>(whole.scene, input, [](const auto& scene) { viewing::check_scene(scene); });
  decode_any<messages::SceneFrame>(whole.frame, input,
                                   [](const auto& frame) { viewing::check_frame(frame, links_of_scene); });
  decode_any<messages::SceneSignals>(whole.signals, input, [](const auto&) {});
  decode_any<messages::SceneContacts>(whole.contacts, input, [](const auto&) {});
  decode_any<messages::SceneRobot>(whole.robot, input, [](const auto&) {});
  return 0;
}
