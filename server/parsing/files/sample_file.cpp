// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/files/sample_file.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "server/core/text.hpp"
#include "server/description/input_error.hpp"

namespace cohort::parsing {
namespace {

constexpr std::size_t most_problems = 20;
constexpr std::string_view distance_column = "distance [m]";
constexpr std::string_view angle_column = "angle [rad]";

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

std::string reading_name(std::size_t index) { return "reading_" + std::to_string(index); }

// Returns the text in brackets after the name, or nothing.
std::optional<std::string> unit_of(std::string_view field, std::string_view name) {
  if (!field.starts_with(name)) return std::nullopt;
  const std::string_view rest = trimmed(field.substr(name.size()));
  if (rest.size() < 3 || rest.front() != '[' || rest.back() != ']') return std::nullopt;
  return std::string(rest.substr(1, rest.size() - 2));
}

class SampleReader {
 public:
  SampleReader(InputFiles& input, const std::filesystem::path& file) : input_(input) { samples_.file = file; }

  Samples read() {
    if (const auto why = input_.why_unreadable(samples_.file)) {
      add_problem(0, "", *why);
      throw InputError(problems_);
    }
    std::istringstream stream(input_.read(samples_.file));
    bool has_header = false;
    int number = 0;
    for (std::string text; std::getline(stream, text) && problems_.size() < most_problems;) {
      ++number;
      const std::string_view line = trimmed(text);
      if (line.empty() || line.front() == '#') continue;
      if (has_header)
        read_place(line, number);
      else
        read_header(line, number);
      has_header = true;
      if (samples_.units.empty()) break;
    }
    if (!has_header) add_problem(0, "", "there is no header; expected 'distance [m],angle [rad],reading_0 [UNIT],...'");
    if (problems_.empty()) check_end(number);
    if (!problems_.empty()) throw InputError(problems_);
    return std::move(samples_);
  }

 private:
  void add_problem(int line, std::string element, std::string message) {
    problems_.push_back({samples_.file, line, std::move(element), std::move(message)});
  }

  void read_header(std::string_view line, int number) {
    const std::vector<std::string_view> names = split(line);
    if (names.size() < 3 || names[0] != distance_column || names[1] != angle_column) {
      add_problem(number, "", "expected 'distance [m],angle [rad],reading_0 [UNIT],...' as the header");
      return;
    }
    std::vector<std::string> units;
    for (std::size_t i = 2; i < names.size(); ++i) {
      const std::string name = reading_name(i - 2);
      const auto unit = unit_of(names[i], name);
      if (!unit) {
        add_problem(number, std::string(names[i]),
                    "expected '" + name + " [UNIT]'; write [1] for a dimensionless quantity");
        return;
      }
      units.push_back(*unit);
    }
    samples_.units = std::move(units);
  }

  void read_place(std::string_view line, int number) {
    const std::vector<std::string_view> fields = split(line);
    if (fields.size() != samples_.count() + 2) {
      add_problem(number, "",
                  "expected " + std::to_string(samples_.count() + 2) + " values, as in the header; found " +
                      std::to_string(fields.size()));
      return;
    }
    std::vector<double> values;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const auto value = parse_real(fields[i]);
      if (!value || !std::isfinite(*value)) {
        const std::string name = i == 0 ? "distance" : i == 1 ? "angle" : reading_name(i - 2);
        add_problem(number, name, "expected a finite number, found '" + std::string(fields[i]) + "'");
        return;
      }
      values.push_back(*value);
    }
    // Only the first error in the grid is reported, since it affects everything after it.
    if (!is_grid_broken_ && !add_place(values[0], values[1], number)) is_grid_broken_ = true;
    samples_.readings.insert(samples_.readings.end(), values.begin() + 2, values.end());
  }

  bool add_place(double distance, double angle, int number) {
    std::vector<double>& distances = samples_.distances;
    std::vector<double>& angles = samples_.angles;
    if (distances.empty() || distance != distances.back()) {
      if (distance < 0.0) return refuse(number, "distance", "expected at least 0 m");
      if (!distances.empty() && distance < distances.back())
        return refuse(number, "distance",
                      "expected at least " + shortest_text(distances.back()) + ", the distance in the previous line");
      if (!distances.empty() && angles_here_ < angles.size())
        return refuse(number, "angle",
                      "expected " + shortest_text(angles[angles_here_]) + " at the previous distance; " +
                          "every distance must have the same angles as the first");
      distances.push_back(distance);
      angles_here_ = 0;
    }
    if (distances.size() == 1) {
      if (!angles.empty() && angle <= angles.back())
        return refuse(number, "angle",
                      "expected more than " + shortest_text(angles.back()) + ", as angles must increase");
      if (!angles.empty() && angle - angles.front() >= 2.0 * std::numbers::pi)
        return refuse(number, "angle", "expected an angle less than a full turn from the first");
      angles.push_back(angle);
    } else if (angles_here_ >= angles.size()) {
      return refuse(number, "angle",
                    "expected the next distance; every distance must have the same angles as the first");
    } else if (angle != angles[angles_here_]) {
      return refuse(number, "angle",
                    "expected " + shortest_text(angles[angles_here_]) +
                        "; every distance must have the same angles as the first");
    }
    ++angles_here_;
    return true;
  }

  bool refuse(int line, std::string element, std::string message) {
    add_problem(line, std::move(element), std::move(message));
    return false;
  }

  void check_end(int last_line) {
    if (samples_.distances.empty())
      add_problem(last_line, "", "expected at least one line of samples after the header");
    else if (angles_here_ < samples_.angles.size())
      add_problem(last_line, "angle",
                  "the file ends before the angle " + shortest_text(samples_.angles[angles_here_]) +
                      "; every distance must have the same angles as the first");
  }

  InputFiles& input_;
  Samples samples_;
  std::vector<Problem> problems_;
  std::size_t angles_here_ = 0;  // at the distance that is being read
  bool is_grid_broken_ = false;
};

}  // namespace

Samples read_samples(const std::filesystem::path& named) {
  const std::filesystem::path file = without_links(named);
  InputFiles disk;
  disk.trust(file);
  return read_samples(disk, file);
}

Samples read_samples(InputFiles& input, const std::filesystem::path& file) { return SampleReader(input, file).read(); }

std::string samples_as_text(const Samples& samples) {
  std::string text = std::string(distance_column) + "," + std::string(angle_column);
  for (std::size_t i = 0; i < samples.count(); ++i) text += "," + reading_name(i) + " [" + samples.units[i] + "]";
  text += '\n';
  std::size_t next = 0;
  for (const double distance : samples.distances)
    for (const double angle : samples.angles) {
      text += shortest_text(distance) + "," + shortest_text(angle);
      for (std::size_t i = 0; i < samples.count(); ++i) text += "," + shortest_text(samples.readings[next++]);
      text += '\n';
    }
  return text;
}

}  // namespace cohort::parsing
