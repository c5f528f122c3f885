// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/recording/replay.hpp"
#include "server/viewing/scene_maker.hpp"
#include "tools/view/messages/scene_publisher.hpp"
#include "tools/view/source.hpp"

namespace cohort::film {

/// Identifies a published message by its topic and its time, which the page also knows.
struct Stamp {
  view::Topic topic;
  std::int64_t time;
};

/// Shows moments of a recording in ascending order, with poses interpolated between ticks. Only `ask` and `watch` are
/// thread-safe.
class FilmSource final : public view::Source {
 public:
  struct Options {
    std::string follow{};  ///< team, robot or object to follow; empty: none
    bool shows_contacts = false;
    unsigned threads = 1;
  };
  /// `recording` and `topics` must outlive this.
  FilmSource(const recording::Recording& recording, view::Topics& topics, Options options);

  /// Goes to the last tick boundary that is not after `log_time`, or to the first one. Throws McapError, and
  /// std::invalid_argument if there is nothing to follow.
  void go_to(std::chrono::nanoseconds log_time);
  /// Returns the scene of the moment. The page must have received it before `show`.
  Stamp scene() const { return {view::Topic::scene, scene_stamp_}; }
  /// Publishes the moment.
  std::vector<Stamp> show();

  /// The place of the followed objects: their centre, and the largest distance of an object from it [m].
  struct Followed {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double radius = 0.0;
  };
  /// Returns the place of the followed objects; nullopt if all of them are absent or none is followed.
  const std::optional<Followed>& followed() const { return shown_.followed; }
  std::chrono::nanoseconds time() const { return time_; }

  void ask(const view::ViewRequest& request, std::function<void(const view::Answer&)> answer) override;
  void watch(const std::vector<std::uint32_t>&) override {}

 private:
  using Nanoseconds = std::chrono::nanoseconds;

  // The data of a tick boundary that are shown.
  struct Moment {
    Nanoseconds log_time{0};
    messages::SceneFrame frame;
    std::optional<Followed> followed;
  };
  void begin(Nanoseconds log_time);
  void prepare_world();
  void keep();
  Moment moment() const;
  void interpolate();
  bool advance();
  std::optional<Followed> find_followed() const;
  std::int64_t next_stamp() { return ++stamps_; }

  const Options options_;
  const recording::Recording& recording_;
  recording::Replay replay_;
  view::ScenePublisher publisher_;
  std::int64_t stamps_ = 0;
  std::int64_t scene_stamp_ = 0;
  std::uint32_t revision_ = 0;

  // The replay is at the first boundary after `time_`, or at the end.
  Nanoseconds time_{0};
  Nanoseconds log_time_{0};  // log time of the replay
  bool has_begun_ = false;
  bool is_at_end_ = false;
  bool is_new_world_ = false;
  std::uint32_t run_ = 0;
  std::optional<viewing::SceneMaker> maker_;
  std::vector<std::uint32_t> followed_objects_;
  Moment kept_;                 // the last boundary that is not after `time_`
  std::optional<Moment> next_;  // the boundary of the replay, once it was needed
  messages::SceneSignals signals_;
  messages::SceneContacts contacts_;
  Moment shown_;  // between the two
};

/// Returns the frame between two frames of the same scene. `share` is 0 at the first and 1 at the second. Only poses
/// are interpolated; everything else is that of the first frame.
messages::SceneFrame interpolated(const messages::SceneFrame& first, const messages::SceneFrame& second, double share);

}  // namespace cohort::film
