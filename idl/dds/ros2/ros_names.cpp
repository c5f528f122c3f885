// SPDX-License-Identifier: Apache-2.0
#include "idl/dds/ros2/ros_names.hpp"

#include <algorithm>

namespace cohort::ros2 {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

}  // namespace

std::string dds_topic(TopicKind kind, std::string_view name) {
  switch (kind) {
    case TopicKind::message: return "rt" + std::string(name);
    case TopicKind::request: return "rq" + std::string(name) + "Request";
    case TopicKind::reply: return "rr" + std::string(name) + "Reply";
  }
  return {};
}

std::optional<std::string> ros_topic(std::string_view dds_topic) {
  for (const std::string_view prefix : {"rt/", "rq/", "rr/"})
    if (dds_topic.starts_with(prefix)) return std::string(dds_topic.substr(2));
  return std::nullopt;
}

std::string dds_type(std::string_view type) {
  std::string result(type);
  replace_all(result, "/", "::");
  const std::size_t at = result.rfind("::");
  return at == std::string::npos ? result : result.substr(0, at) + "::dds_" + result.substr(at) + "_";
}

std::string ros_type(std::string_view dds_type) {
  std::string result(dds_type);
  const std::size_t at = result.find("::dds_::");
  if (at == std::string::npos || !result.ends_with('_')) return result;
  result.pop_back();
  result.erase(at, std::string_view("::dds_").size());
  replace_all(result, "::", "/");
  return result;
}

std::string name_part(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (!is_letter(c) && !is_digit(c)) c = '_';
  if (result.empty() || is_digit(result.front())) result.insert(result.begin(), '_');
  return result;
}

std::string absolute_name(std::string_view name) {
  std::string result;
  while (!name.empty()) {
    const std::string_view part = name.substr(0, name.find('/'));
    name.remove_prefix(std::min(name.size(), part.size() + 1));
    if (!part.empty()) result += "/" + name_part(part);
  }
  return result.empty() ? "/" : result;
}

}  // namespace cohort::ros2
