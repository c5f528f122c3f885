// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "server/core/random.hpp"
#include "server/description/input_error.hpp"
#include "server/parsing/files/sample_file.hpp"
#include "server/sensing/readings/sample_table.hpp"

// Readings of a real sensor: the file, and what lies between them.
namespace cohort::sensing {
namespace {

using description::Samples;
using parsing::read_samples;
using std::numbers::pi;
const std::string header = "distance [m],angle [rad],reading_0 [1],reading_1 [1]\n";

std::filesystem::path written(const std::string& text) {
  const std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / ("samples_" + test + ".csv");
  std::ofstream(file) << text;
  return file;
}

std::string problem_of(const std::string& text) {
  const std::filesystem::path file = written(text);
  try {
    read_samples(file);
  } catch (const description::InputError& error) {
    const std::string name = file.string();
    const std::string what = error.what();
    return what.starts_with(name) ? what.substr(name.size() + 1) : what;
  }
  return "none";
}

TEST(SampleFile, IsReadWithItsUnitsAndComments) {
  const Samples samples =
      read_samples(written("# an s-bot beside a wall\n\n" + header +
                           "0.01, -1, 0.5, 1\n0.01,1,0.25,2\n# far\n0.02,-1,0,3\n0.02,1,-4e-1,+4\n"));
  EXPECT_EQ(samples.distances, (std::vector<double>{0.01, 0.02}));
  EXPECT_EQ(samples.angles, (std::vector<double>{-1, 1}));
  EXPECT_EQ(samples.units, (std::vector<std::string>{"1", "1"}));
  EXPECT_EQ(samples.readings, (std::vector<double>{0.5, 1, 0.25, 2, 0, 3, -0.4, 4}));
}

TEST(SampleFile, IsWrittenAndReadWithTheSameBits) {
  const RandomStream random(61, "samples_test", "readings");
  Samples samples;
  for (std::uint64_t i = 0; i < 7; ++i)
    samples.distances.push_back(0.1 * static_cast<double>(i) + 0.01 * random.uniform(i, 0));
  for (std::uint64_t i = 0; i < 11; ++i)
    samples.angles.push_back(0.5 * static_cast<double>(i) - pi + 0.1 * random.uniform(i, 1));
  samples.units = {"1", "lx", "Pa"};
  for (std::uint64_t i = 0; i < 7 * 11 * 3; ++i)
    samples.readings.push_back(random.normal(i, 2) * std::exp(40 * random.normal(i, 4)));
  samples.readings[0] = -0.0;
  samples.readings[1] = std::numeric_limits<double>::denorm_min();
  samples.readings[2] = std::numeric_limits<double>::max();
  const std::filesystem::path file = written(parsing::samples_as_text(samples));
  const Samples again = read_samples(file);
  EXPECT_EQ(again.distances, samples.distances);
  EXPECT_EQ(again.angles, samples.angles);
  EXPECT_EQ(again.units, samples.units);
  EXPECT_EQ(again.readings, samples.readings);
  EXPECT_TRUE(std::signbit(again.readings[0]));
  EXPECT_EQ(again.file, file);
}

TEST(SampleFile, IsRejectedWithTheLineAndTheExpectedContent) {
  EXPECT_EQ(problem_of("# nothing\n"), " there is no header; expected 'distance [m],angle [rad],reading_0 [UNIT],...'");
  EXPECT_EQ(problem_of("distance [cm],angle [rad],reading_0 [1]\n"),
            "1: expected 'distance [m],angle [rad],reading_0 [UNIT],...' as the header");
  EXPECT_EQ(problem_of("distance [m],angle [rad],reading_1 [1]\n"),
            "1: reading_1 [1]: expected 'reading_0 [UNIT]'; write [1] for a dimensionless quantity");
  EXPECT_EQ(problem_of(header), "1: expected at least one line of samples after the header");
  EXPECT_EQ(problem_of(header + "0.1,0,1\n"), "2: expected 4 values, as in the header; found 3");
  EXPECT_EQ(problem_of(header + "0.1,0,1,nan\n"), "2: reading_1: expected a finite number, found 'nan'");
  EXPECT_EQ(problem_of(header + "0.1,0,1,2 V\n"), "2: reading_1: expected a finite number, found '2 V'");
  EXPECT_EQ(problem_of(header + "-0.1,0,1,2\n"), "2: distance: expected at least 0 m");
}

TEST(SampleFile, IsRejectedIfItIsNotAGrid) {
  const std::string first = header + "0.1,0,1,2\n0.1,1,1,2\n";
  EXPECT_EQ(problem_of(first + "0.05,0,1,2\n"),
            "4: distance: expected at least 0.1, the distance in the previous line");
  EXPECT_EQ(problem_of(first + "0.1,0.5,1,2\n"), "4: angle: expected more than 1, as angles must increase");
  EXPECT_EQ(problem_of(first + "0.1,6.3,1,2\n"), "4: angle: expected an angle less than a full turn from the first");
  EXPECT_EQ(problem_of(first + "0.2,0,1,2\n0.2,1.5,1,2\n"),
            "5: angle: expected 1; every distance must have the same angles as the first");
  EXPECT_EQ(problem_of(first + "0.2,0,1,2\n0.3,0,1,2\n"),
            "5: angle: expected 1 at the previous distance; every distance must have the same angles as the first");
  EXPECT_EQ(problem_of(first + "0.2,0,1,2\n0.2,1,1,2\n0.2,2,1,2\n"),
            "6: angle: expected the next distance; every distance must have the same angles as the first");
  EXPECT_EQ(problem_of(first + "0.2,0,1,2\n"),
            "4: angle: the file ends before the angle 1; every distance must have the same angles as the first");
}

// A reading that is linear in distance and angle over each cell is met everywhere.
Samples sloped() {
  Samples samples;
  samples.distances = {0.1, 0.2, 0.4};
  samples.angles = {-2.0, 0.0, 1.5};
  samples.units = {"1", "1"};
  for (const double distance : samples.distances)
    for (const double angle : samples.angles) {
      samples.readings.push_back(3.0 - 2.0 * distance + 0.5 * angle + distance * angle);
      samples.readings.push_back(distance);
    }
  return samples;
}

std::shared_ptr<const Samples> shared(Samples samples) { return std::make_shared<const Samples>(std::move(samples)); }

TEST(SampleTable, IsBilinearBetweenSamples) {
  const SampleTable table(shared(sloped()));
  for (const double distance : {0.1, 0.13, 0.2, 0.35, 0.4})
    for (const double angle : {-2.0, -1.1, 0.0, 0.7, 1.5}) {
      const double expected = 3.0 - 2.0 * distance + 0.5 * angle + distance * angle;
      EXPECT_NEAR(table.reading(distance, angle, 0), expected, 1e-14) << distance << " " << angle;
      EXPECT_NEAR(table.reading(distance, angle + 4 * pi, 0), expected, 1e-13);
      EXPECT_NEAR(table.reading(distance, angle - 2 * pi, 0), expected, 1e-13);
      EXPECT_NEAR(table.reading(distance, angle, 1), distance, 1e-15);
    }
}

TEST(SampleTable, WrapsFromTheLastAngleToTheFirst) {
  const SampleTable table(shared(sloped()));
  const double last = table.reading(0.2, 1.5, 0), first = table.reading(0.2, -2.0, 0);
  const double middle = 0.5 * (1.5 + (2 * pi - 2.0));
  EXPECT_NEAR(table.reading(0.2, middle, 0), 0.5 * (last + first), 1e-14);
  EXPECT_NEAR(table.reading(0.2, std::nextafter(-2.0, -3.0), 0), first, 1e-14);
}

TEST(SampleTable, UsesTheFirstRowBelowItAndIsZeroBeyondTheLast) {
  const SampleTable table(shared(sloped()));
  EXPECT_EQ(table.reading(0.0, 0.7, 0), table.reading(0.1, 0.7, 0));
  EXPECT_NE(table.reading(0.4, 0.7, 0), 0.0);
  EXPECT_EQ(table.reading(std::nextafter(0.4, 1.0), 0.7, 0), 0.0);
}

TEST(SampleTable, OfASingleSampleIsTheSameInAllDirections) {
  const SampleTable table(shared(Samples{{0.1}, {1.0}, {"1"}, {7.0}}));
  for (const double angle : {-4.0, 0.0, 1.0, 2.0}) EXPECT_EQ(table.reading(0.05, angle, 0), 7.0);
}

TEST(SampleTable, CombinesObjectsByTheGreatestOrTheSum) {
  const SampleTable table(shared(sloped()));
  std::vector<double> greatest(2, 0.0), sum(2, 0.0);
  for (const double distance : {0.2, 0.4, 0.5}) {
    table.keep_greatest(distance, 0.0, greatest);
    table.add(distance, 0.0, 0.5, sum);
  }
  EXPECT_NEAR(greatest[0], 2.6, 1e-15);
  EXPECT_NEAR(greatest[1], 0.4, 1e-15);
  EXPECT_NEAR(sum[0], 0.5 * (2.6 + 2.2), 1e-15);
  EXPECT_NEAR(sum[1], 0.5 * 0.6, 1e-15);
}

TEST(SampleTable, RejectsAnIncompleteGrid) {
  Samples samples = sloped();
  samples.readings.pop_back();
  EXPECT_THROW(SampleTable{shared(samples)}, std::invalid_argument);
  samples = sloped();
  samples.angles.back() = 5.0;
  EXPECT_THROW(SampleTable{shared(samples)}, std::invalid_argument);
}

}  // namespace
}  // namespace cohort::sensing
