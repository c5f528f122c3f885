// SPDX-License-Identifier: Apache-2.0
#include "tools/view/film/browser/dev_tools.hpp"

#include <chrono>
#include <stdexcept>

namespace cohort::film {
namespace {

constexpr std::size_t most_of_message = std::size_t{64}
                                        << 20;  // longest message: a picture of the largest size, without compression
constexpr std::chrono::seconds patience{300};   // software may draw a picture of a large world that slowly

}  // namespace

DevTools::Json DevTools::call(const std::string& method, const Json& parameters) {
  const std::int64_t id = ++calls_;
  Json request = {{"id", id}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) request["sessionId"] = session_;
  std::string text = request.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.push_back('\0');
  browser_.send(text);
  for (;;) {
    const Json message = Json::parse(browser_.receive('\0', most_of_message, patience), nullptr, false);
    if (!message.is_object()) throw std::runtime_error("the browser sends invalid messages");
    if (message.value("method", "") == "Inspector.targetCrashed" ||
        message.value("method", "") == "Target.targetCrashed")
      throw std::runtime_error("the page of the browser has crashed; its memory may be too small for this world");
    if (message.value("id", std::int64_t{0}) != id) continue;  // an event
    if (const auto error = message.find("error"); error != message.end())
      throw std::runtime_error("the browser refuses " + method + ": " + error->value("message", ""));
    return message.value("result", Json::object());
  }
}

void DevTools::open_page(const std::string& address, std::uint32_t width, std::uint32_t height) {
  const Json target = call("Target.createTarget", {{"url", "about:blank"}});
  session_ = call("Target.attachToTarget", {{"targetId", target.at("targetId")}, {"flatten", true}}).at("sessionId");
  call("Inspector.enable");
  call("Emulation.setDeviceMetricsOverride",
       {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
  const Json opened = call("Page.navigate", {{"url", address}});
  if (const auto error = opened.find("errorText"); error != opened.end())
    throw std::runtime_error("the browser cannot open the page: " + error->get<std::string>());
}

DevTools::Json DevTools::evaluate(const std::string& expression) {
  const Json result =
      call("Runtime.evaluate", {{"expression", expression}, {"awaitPromise", true}, {"returnByValue", true}});
  if (const auto details = result.find("exceptionDetails"); details != result.end()) {
    const Json exception = details->value("exception", Json::object());
    const std::string text = exception.value("description", details->value("text", "unknown"));
    throw std::runtime_error("an error in the page: " + text.substr(0, text.find('\n')));
  }
  const Json value = result.value("result", Json::object());
  return value.value("value", Json());
}

}  // namespace cohort::film
