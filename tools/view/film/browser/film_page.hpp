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

/// The look of pictures, and what they show besides the world.
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
  std::optional<double> distance{};  ///< distance of the camera from its target [m]; by default so that all is visible
};

/// Where the camera is in a picture: at a viewpoint, or as at first, moved with what is followed.
struct FilmCamera {
  std::optional<Viewpoint> viewpoint{};
  std::optional<FilmSource::Followed> followed{};
};

/// The page of the view in a headless browser, of which each picture is drawn when it is asked for.
class FilmPage {
 public:
  /// Returns the browser. Throws std::runtime_error that names the Debian package if there is none.
  static std::filesystem::path find_browser();

  /// Opens the page. Throws std::runtime_error. `stop` must outlive this.
  FilmPage(const std::filesystem::path& browser, const std::string& address, const FilmLook& look,
           const std::atomic<bool>& stop);
  ~FilmPage();

  /// Returns when the page has taken these messages.
  void await(const std::vector<Stamp>& stamps);
  /// Returns the picture (PNG) of the messages that the page has taken. `time`: in the recording [s].
  std::string draw(double time, const FilmCamera& camera);

 private:
  class Browser;
  std::unique_ptr<Browser> browser_;
};

}  // namespace cohort::film
