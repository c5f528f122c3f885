// SPDX-License-Identifier: Apache-2.0
#include "tools/view/history/reduction.hpp"

#include <algorithm>
#include <cmath>

namespace cohort::view {

Reduction::Reduction(std::chrono::nanoseconds from, std::chrono::nanoseconds to, std::size_t most)
    : from_(from), to_(to), most_(std::max(most, least)) {}

void Reduction::add(Sample sample) {
  if (sample.time < from_ || sample.time > to_) return;
  sample.value += 0.0;
  if (parts_.empty()) {
    all_.push_back(sample);
    if (all_.size() <= most_) return;
    parts_.resize((most_ - 2) / 2);
    first_ = last_ = all_.front();
    for (const Sample& each : all_) put(each);
    all_ = {};
    return;
  }
  put(sample);
}

void Reduction::put(const Sample& sample) {
  if (sample.time < first_.time) first_ = sample;
  if (sample.time >= last_.time) last_ = sample;
  Part& part = parts_[part_of(sample.time)];
  // The negations also replace a NaN.
  if (!part.has_any || (!(part.least.value <= sample.value) && !std::isnan(sample.value))) part.least = sample;
  if (!part.has_any || (!(part.greatest.value >= sample.value) && !std::isnan(sample.value))) part.greatest = sample;
  part.has_any = true;
}

std::size_t Reduction::part_of(std::chrono::nanoseconds time) const {
  const double share = static_cast<double>((time - from_).count()) / static_cast<double>((to_ - from_).count() + 1);
  return std::min(parts_.size() - 1, static_cast<std::size_t>(share * static_cast<double>(parts_.size())));
}

std::vector<Sample> Reduction::samples() const {
  const auto is_earlier = [](const Sample& a, const Sample& b) { return a.time < b.time; };
  std::vector<Sample> result = all_;
  if (!parts_.empty()) result.push_back(first_);
  for (const Part& part : parts_) {
    if (!part.has_any) continue;
    const auto [earlier, later] = std::minmax(part.least, part.greatest, is_earlier);
    result.push_back(earlier);
    if (earlier.time != later.time) result.push_back(later);
  }
  if (!parts_.empty()) result.push_back(last_);
  std::ranges::stable_sort(result, is_earlier);
  // Several samples may have one time, such as the end of a world and the beginning of the next: the last one counts.
  std::vector<Sample> distinct;
  distinct.reserve(result.size());
  for (const Sample& each : result) {
    if (!distinct.empty() && distinct.back().time == each.time)
      distinct.back() = each;
    else
      distinct.push_back(each);
  }
  return distinct;
}

}  // namespace cohort::view
