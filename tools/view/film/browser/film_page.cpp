// SPDX-License-Identifier: Apache-2.0
#include "tools/view/film/browser/film_page.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "tools/view/film/browser/dev_tools.hpp"

namespace cohort::film {
namespace {

using Json = DevTools::Json;

// A folder that is deleted with its contents.
class ScratchFolder {
 public:
  ScratchFolder() {
    path_ = (std::filesystem::temp_directory_path() / "cohort-film-XXXXXX").string();
    if (mkdtemp(path_.data()) == nullptr)
      throw std::system_error(errno, std::generic_category(), "cannot make a temporary folder");
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  // The browser's handlers of crashes, which are in no process group of it, may still be starting in the folder.
  ~ScratchFolder() {
    constexpr int most_attempts = 200;
    std::error_code error;
    for (int i = 0; i < most_attempts; ++i) {
      std::filesystem::remove_all(path_, error);
      if (!error) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// Pictures are drawn in software, so that they do not depend on a graphics card.
std::vector<std::string> command_of(const std::filesystem::path& browser, const std::string& profile) {
  std::vector<std::string> command = {browser.string(),
                                      "--headless",
                                      "--remote-debugging-pipe",
                                      "--user-data-dir=" + profile,
                                      "--use-angle=swiftshader",
                                      "--enable-unsafe-swiftshader",
                                      "--force-color-profile=srgb",
                                      "--hide-scrollbars",
                                      "--mute-audio",
                                      "--no-first-run",
                                      "--no-default-browser-check",
                                      "--no-proxy-server",
                                      "--disable-background-networking",
                                      "--disable-background-timer-throttling",
                                      "--disable-backgrounding-occluded-windows",
                                      "--disable-renderer-backgrounding",
                                      "--disable-breakpad",
                                      "--disable-component-update",
                                      "--disable-default-apps",
                                      "--disable-dev-shm-usage",
                                      "--disable-extensions",
                                      "--disable-sync"};
  if (geteuid() == 0) command.emplace_back("--no-sandbox");  // chromium has no sandbox for root
  return command;
}

// All that the browser writes is in its profile, also if it is killed.
std::vector<std::string> variables_of(const std::string& profile) {
  return {"HOME=" + profile, "TMPDIR=" + profile, "XDG_CONFIG_HOME=" + profile, "XDG_CACHE_HOME=" + profile};
}

// Decodes base64 (RFC 4648). Throws std::runtime_error.
std::string decoded(std::string_view text) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<int, 256> values{};
  values.fill(-1);
  for (std::size_t i = 0; i < digits.size(); ++i) values[static_cast<unsigned char>(digits[i])] = static_cast<int>(i);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char letter : text.substr(0, text.find('='))) {
    const int value = values[static_cast<unsigned char>(letter)];
    if (value < 0) throw std::runtime_error("the page sends an invalid picture");
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<char>(bits >> count & 0xff));
  }
  return bytes;
}

Json json_of(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

Json json_of(const FilmLook& look) {
  Json layers = Json::array();
  if (look.shows_labels) layers.push_back("labels");
  if (look.shows_trails) layers.push_back("trails");
  if (look.shows_contacts) layers.push_back("contacts");
  if (look.has_shadows) layers.push_back("shadows");
  Json json = {{"width", look.size.width},    {"height", look.size.height},     {"theme", look.theme},
               {"caption", look.caption},     {"showsClock", look.shows_clock}, {"layers", layers},
               {"fromAbove", look.from_above}};
  if (look.distance) json["distance"] = *look.distance;
  return json;
}

}  // namespace

class FilmPage::Browser {
 public:
  Browser(const std::filesystem::path& program, const std::atomic<bool>& stop)
      : process_(command_of(program, profile_.path()), {3, 4}, stop, variables_of(profile_.path())) {}
  ~Browser() { process_.close(std::chrono::seconds(2)); }
  DevTools& tools() { return tools_; }

 private:
  ScratchFolder profile_;  // is deleted when the browser has ended
  tool::ConnectedProgram process_;
  DevTools tools_{process_};
};

std::filesystem::path FilmPage::find_browser() {
  for (const char* const name : {"chromium", "chromium-browser", "google-chrome"})
    if (auto found = tool::find_program(name)) return *found;
  throw std::runtime_error(
      "the program chromium, which draws the pictures of a film, is missing: install the Debian package chromium");
}

FilmPage::FilmPage(const std::filesystem::path& browser, const std::string& address, const FilmLook& look,
                   const std::atomic<bool>& stop)
    : browser_(std::make_unique<Browser>(browser, stop)) {
  DevTools& tools = browser_->tools();
  tools.open_page(address, look.size.width, look.size.height);
  tools.evaluate(
      "new Promise(function look(resolve) { window.cohort?.film ? resolve() : setTimeout(look, 10, resolve) })");
  tools.evaluate(fmt::format("window.cohort.film.prepare({})", json_of(look).dump()));
}

FilmPage::~FilmPage() = default;

void FilmPage::await(const std::vector<Stamp>& stamps) {
  Json awaited = Json::object();
  for (const Stamp& stamp : stamps)
    awaited[view::topic_table().at(static_cast<std::size_t>(stamp.topic)).name] = stamp.time;
  browser_->tools().evaluate(fmt::format("window.cohort.film.received({})", awaited.dump()));
}

std::string FilmPage::draw(double time, const FilmCamera& camera) {
  Json moment = {{"time", time}};
  if (camera.viewpoint)
    moment["viewpoint"] = {{"position", json_of(camera.viewpoint->position)},
                           {"target", json_of(camera.viewpoint->target)}};
  if (camera.followed)
    moment["followed"] = {{"centre", json_of(camera.followed->centre)}, {"radius", camera.followed->radius}};
  const Json picture = browser_->tools().evaluate(fmt::format("window.cohort.film.draw({})", moment.dump()));
  constexpr std::string_view prefix = "data:image/png;base64,";
  const auto& text = picture.get_ref<const std::string&>();
  if (!text.starts_with(prefix)) throw std::runtime_error("the page has drawn no picture");
  return decoded(std::string_view(text).substr(prefix.size()));
}

}  // namespace cohort::film
