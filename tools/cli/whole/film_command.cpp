// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "server/core/processors.hpp"
#include "server/core/text.hpp"
#include "server/recording/run_messages.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/recording_part.hpp"
#include "tools/cli/commands/refuse_experiment.hpp"
#include "tools/cli/common/installed_files.hpp"
#include "tools/cli/common/output_file.hpp"
#include "tools/cli/common/wording.hpp"
#include "tools/common/processes/connected_program.hpp"
#include "tools/view/film/browser/film_page.hpp"
#include "tools/view/film/camera_path.hpp"
#include "tools/view/film/film_source.hpp"
#include "tools/view/film/film_writer.hpp"
#include "tools/view/web/admission.hpp"
#include "tools/view/web/web_server.hpp"

namespace cohort::tool {
namespace {

struct FilmCommand {
  std::filesystem::path recording;
  std::filesystem::path output;
  RecordingPart part{};
  double speed = 1.0;  ///< simulated time per time of the film
  unsigned fps = 30;
  std::string size = "1280x720";
  film::FilmLook look{};
  std::string follow{};
  std::filesystem::path camera{};  ///< file of a camera path
  unsigned threads = 0;            ///< threads that replay the recording; 0: one for each core
};

constexpr std::uint32_t least_pixels = 16;  // width or height
constexpr std::uint32_t most_pixels = 4096;
constexpr std::uint32_t most_pixels_in_all = 3840U * 2160U;
constexpr std::uint64_t most_pictures = 200'000;  // almost two hours
constexpr std::size_t longest_caption = 200;      // bytes

// Parses `1280x720`. Throws std::invalid_argument.
film::FilmSize size_of(const std::string& text) {
  const std::size_t cross = text.find('x');
  const auto side = [&](std::string_view part) { return parse_whole(part).value_or(0); };
  const std::uint64_t width = cross == std::string::npos ? 0 : side(std::string_view(text).substr(0, cross));
  const std::uint64_t height = cross == std::string::npos ? 0 : side(std::string_view(text).substr(cross + 1));
  const auto is_side = [](std::uint64_t pixels) { return pixels >= least_pixels && pixels <= most_pixels; };
  if (!is_side(width) || !is_side(height) || width * height > most_pixels_in_all)
    throw std::invalid_argument(
        fmt::format("--size {}: expected WIDTHxHEIGHT in pixels, from {} to {} each and at most 3840x2160 in all", text,
                    least_pixels, most_pixels));
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

// The times of pictures in the recording.
struct Schedule {
  std::chrono::nanoseconds begin{0};
  double interval = 0.0;  ///< [s]
  std::uint64_t count = 1;

  std::chrono::nanoseconds time(std::uint64_t picture) const {
    return begin + nanoseconds(static_cast<double>(picture) * interval);
  }
};

std::chrono::nanoseconds end_of(const recording::Recording& recording) {
  std::chrono::nanoseconds end{0};
  if (recording.reader().channel(recording::Boundary::topic) == nullptr) return end;
  for (const recording::Block& block : recording.reader().blocks())
    end = std::max(end, std::chrono::nanoseconds(block.end_time));
  return end;
}

// A film of T seconds has T times fps pictures, so its last one is before its end.
Schedule schedule_of(const FilmCommand& command, const recording::Recording& recording, bool is_single) {
  const std::chrono::nanoseconds last = end_of(recording);
  const std::chrono::nanoseconds begin = std::max(start_of_part(command.part), recording.worlds().front().log_time);
  const std::chrono::nanoseconds end = std::min(end_of_part(command.part), last);
  if (begin > end) throw std::invalid_argument(nothing_in_part);
  Schedule schedule{begin, command.speed / command.fps, 1};
  if (is_single) return schedule;
  const double pictures = std::ceil(seconds(end - begin) / schedule.interval - 1e-6);
  if (pictures > static_cast<double>(most_pictures))
    throw std::invalid_argument(
        fmt::format("the film would have {:.0f} pictures, more than {}: choose a shorter part, "
                    "a higher --speed or a lower --fps",
                    pictures, most_pictures));
  schedule.count = std::max(std::uint64_t{1}, static_cast<std::uint64_t>(pictures));
  return schedule;
}

// Serves the page of the view to the browser of this film only.
class FilmServer {
 public:
  FilmServer(view::PageFiles page, view::Topics& topics)
      : token_(view::random_token()), server_({.name = "film", .port = 0, .token = token_}, std::move(page), topics) {}
  FilmServer(const FilmServer&) = delete;
  FilmServer& operator=(const FilmServer&) = delete;
  ~FilmServer() {
    server_.stop();
    if (thread_.joinable()) thread_.join();
  }
  void published() { server_.published(); }
  void start(view::Source& source) {
    thread_ = std::thread([this, &source] { server_.run(source); });
  }
  std::string address() const { return fmt::format("http://127.0.0.1:{}/#token={}&film", server_.port(), token_); }

 private:
  std::string token_;
  view::WebServer server_;
  std::thread thread_;
};

// Shows how many pictures have been drawn, several times per second.
class FilmProgress {
 public:
  FilmProgress(Log& log, std::uint64_t count) : log_(log), count_(count) {}
  ~FilmProgress() { log_.clear_progress(); }
  void at(std::uint64_t drawn) {
    constexpr std::chrono::milliseconds interval{200};
    const auto now = std::chrono::steady_clock::now();
    if (!log_.rewrites_progress() || now - last_ < interval) return;
    last_ = now;
    const double left = seconds(now - begin_) / static_cast<double>(drawn) * static_cast<double>(count_ - drawn);
    log_.progress(fmt::format("{:6} of {} pictures, {:.0f} s left", drawn, count_, left));
  }

 private:
  Log& log_;
  std::uint64_t count_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_ = begin_;
};

// Chooses the viewpoint of each picture.
class Director {
 public:
  explicit Director(std::optional<film::CameraPath> path) : path_(std::move(path)) {}

  // An object that was followed and has left the world keeps its last place.
  film::FilmCamera camera(const film::FilmSource& source) {
    if (source.followed()) followed_ = source.followed();
    film::FilmCamera camera{{}, followed_};
    if (!path_) return camera;
    camera.viewpoint = path_->at(seconds(source.time()));
    if (followed_) {
      camera.viewpoint->position += followed_->centre;
      camera.viewpoint->target += followed_->centre;
    }
    return camera;
  }

 private:
  std::optional<film::CameraPath> path_;
  std::optional<film::FilmSource::Followed> followed_;
};

view::PageFiles page_of_view() {
  view::PageFiles page = view::read_page(installed_page_folder());
  if (page.empty())
    throw std::runtime_error(
        "the browser page, which draws films, was not built. Install node 18 and npm ('tools/dev/install-packages "
        "tools/dev/packages-node.txt'), then run 'cmake --build build/release --target view_page'");
  return page;
}

void draw_film(const FilmCommand& command, const recording::Recording& recording, film::FilmWriter& writer, Log& log,
               const std::atomic<bool>& stop) {
  const Schedule schedule = schedule_of(command, recording, writer.is_single());
  std::optional<film::CameraPath> path;
  if (!command.camera.empty()) path = film::read_camera_path(command.camera);
  const std::filesystem::path browser = film::FilmPage::find_browser();
  const std::string follow = path ? path->follow().value_or(command.follow) : command.follow;

  FilmServer* published_to = nullptr;
  view::Topics topics([&] {
    if (published_to != nullptr) published_to->published();
  });
  film::FilmSource source(
      recording, topics,
      {follow, command.look.shows_contacts, command.threads == 0 ? available_processors() : command.threads});
  source.go_to(schedule.begin);  // errors of the recording come before the browser is started
  FilmServer server(page_of_view(), topics);
  published_to = &server;
  server.start(source);
  film::FilmPage page(browser, server.address(), command.look, stop);
  Director director(std::move(path));
  FilmProgress progress(log, schedule.count);
  for (std::uint64_t picture = 0; picture < schedule.count; ++picture) {
    source.go_to(schedule.time(picture));
    page.await({source.scene()});
    page.await(source.show());
    writer.add(page.draw(seconds(source.time()), director.camera(source)));
    progress.at(picture + 1);
  }
  writer.finish();
}

int make_film(FilmCommand command, Log& log, const std::atomic<bool>& stop) {
  command.look.size = size_of(command.size);
  if (command.look.caption.size() > longest_caption)
    throw std::invalid_argument(fmt::format("--caption: expected at most {} bytes", longest_caption));
  if (!film::has_numbers(command.output)) check_writable("the film", command.output);
  refuse_experiment(command.recording);
  const recording::Recording recording(command.recording);
  if (!recording.damage().empty()) log.warning(recording.damage());
  try {
    const auto writer = film::make_film_writer(command.output, command.look.size, command.fps, stop);
    draw_film(command, recording, *writer, log, stop);
  } catch (const Interrupted&) {
    return exit_interrupted;
  }
  return exit_ok;
}

}  // namespace

Subcommand add_film(CommandLine app) {
  const auto command = std::make_shared<FilmCommand>();
  film::FilmLook& look = command->look;
  CommandLine line = app.add_subcommand(in_whole::film.name, in_whole::film.text);
  line.add_option("RECORDING", command->recording, "Recording (MCAP)").required().type_name("");
  line.add_option("-o,--output", command->output,
                  "Film to write (.mp4, .webm, .gif or .webp), or picture (.png); frame_%04d.png writes numbered "
                  "pictures")
      .required()
      .type_name("FILE");
  add_part_options(line, command->part);
  line.add_option("--speed", command->speed, "Simulated time per time of the film")
      .check(number_above_zero(1e6))
      .capture_default_str()
      .type_name("FACTOR");
  line.add_option("--fps", command->fps, "Pictures per second of the film")
      .check(whole_number(1, 120))
      .capture_default_str()
      .type_name("N");
  line.add_option("--size", command->size, "Width and height in pixels").capture_default_str().type_name("WxH");
  line.add_option("--theme", look.theme, "Colours of the picture")
      .check(one_of({"light", "dark"}))
      .capture_default_str()
      .type_name("light|dark");
  const Option follow =
      line.add_option("--follow", command->follow, "Team, robot or object with which the camera moves")
          .type_name("NAME");
  const Option camera = line.add_option("--camera", command->camera, "Camera path (YAML, 'docs/view.md')")
                            .excludes(follow)
                            .type_name("FILE");
  line.add_flag("--top", look.from_above, "Look from above").excludes(camera);
  line.add_option("--distance", look.distance,
                  "Distance of the camera from what it looks at, in metres (default: so that all robots, or all "
                  "followed ones, are visible at first)")
      .check(number_above_zero(1e4, "metres"))
      .excludes(camera)
      .type_name("M");
  line.add_option("--caption", look.caption, "Text in the picture").type_name("TEXT");
  line.add_flag("--clock", look.shows_clock, "Show the simulated time");
  line.add_flag("--labels", look.shows_labels, "Show the names of robots");
  line.add_flag("--trails", look.shows_trails, "Show the paths of robots");
  line.add_flag("--contacts", look.shows_contacts, "Show contacts and their forces");
  line.add_flag("--no-shadows{false}", look.has_shadows, "Draw no shadows, which is faster");
  line.add_option("--threads", command->threads, "Threads that replay the recording (default: one per core)")
      .check(whole_number(1, 1024))
      .type_name("N");
  line.footer("Example: cohort film run.mcap -o run.mp4 --follow sbot_3 --trails");
  return {line, [command](Log& log, const std::atomic<bool>& stop) { return make_film(*command, log, stop); }};
}

}  // namespace cohort::tool
