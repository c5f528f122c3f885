#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/description/input_file.hpp"

namespace cohort::description {

/// Readings of a real sensor, taken for one object at a grid of places around the robot (thesis, section 2.3.2: indexed
/// by the distance between robot and object, by the angle between the robot's front and the object, and by the single
/// sensor).
struct Samples {
  std::vector<double> distances;   ///< [m], >= 0, ascending
  std::vector<double> angles;      ///< [rad], ascending, over less than a full turn
  std::vector<std::string> units;  ///< of each reading
  std::vector<double> readings;    ///< by distance, then by angle, then by reading
  std::filesystem::path file{};    ///< where they came from, if anywhere

  std::size_t count() const { return units.size(); }  ///< of readings at each place
};

/// Reads comma-separated values:
///
///     # anything
///     distance [m],angle [rad],reading_0 [1],reading_1 [1]
///     0.01,-1.5708,0.9,0.2
///
/// The first line that is neither empty nor a comment names the columns and their units; readings are numbered from 0.
/// Then come the places, by distance and then by angle, with every angle at every distance. Throws InputError with all
/// that is wrong, but for what follows from it.
Samples read_samples(const std::filesystem::path& file);
Samples read_samples(InputFiles& input, const std::filesystem::path& file);

/// The same as text: read again, it gives the same bits.
std::string samples_as_text(const Samples& samples);

/// Throws std::runtime_error if the file cannot be written.
void write_samples(const Samples& samples, const std::filesystem::path& file);

}  // namespace cohort::description
