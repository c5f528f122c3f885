// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/view/film/camera_path.hpp"
#include "tools/view/film/film_source.hpp"
#include "tools/view/film/film_writer.hpp"

namespace cohort::film {

/// The look of pictures, and the elements that they show in addition to the world.
struct FilmLook {
  FilmSize size{};
  std::string theme = "light";
  std::string caption{};
  bool shows_clock = false;
  bool shows_labels = false;
  bool shows_trails = false;
  bool shows_contacts = false;
  bool has_shadows = true;
  bool from_above = false;
  std::optional<double> distance{};  ///< distance of the camera from its target [m]; by default, everything is visible
};

/// The camera of a picture: at a viewpoint, or at the initial one, moved with the followed objects.
struct FilmCamera {
  std::optional<Viewpoint> viewpoint{};
  std::optional<FilmSource::Followed> followed{};
};

/// The page of the view in a headless browser, which draws a picture when requested.
class FilmPage {
 public:
  /// Returns the path of the browser. Throws std::runtime_error that names the Debian package if there is none.
  static std::filesystem::path find_browser();

  /// Opens the page. Throws std::runtime_error. `stop` must outlive this.
  FilmPage(const std::filesystem::path& browser, const std::string& address, const FilmLook& look,
           const std::atomic<bool>& stop);
  ~FilmPage();

  /// Waits until the page has processed these messages.
  void await(const std::vector<Stamp>& stamps);
  /// Returns a picture (PNG) of the messages that the page has processed. `time` is the log time in the recording [s].
  std::string draw(double time, const FilmCamera& camera);

 private:
  class Browser;
  std::unique_ptr<Browser> browser_;
};

}  // namespace cohort::film
