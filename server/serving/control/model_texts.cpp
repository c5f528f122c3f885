// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/model_texts.hpp"

#include <algorithm>
#include <exception>

namespace cohort::session {

namespace {

using wire::ResultCode;

}  // namespace

ModelTexts::ModelTexts(std::function<void()> on_read)
    : on_read_(std::move(on_read)), thread_([this] { read_texts(); }) {}

ModelTexts::~ModelTexts() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void ModelTexts::begin(description::ModelReader read_model) {
  ++run_;
  read_model_ = std::move(read_model);
  readings_.clear();
  last_.clear();
}

bool ModelTexts::is_free() {
  const std::lock_guard lock(mutex_);
  return !job_ && readings_.size() < most_readings;
}

bool ModelTexts::take(const Key& key, const std::string& text) {
  const auto known = std::ranges::find_if(last_, [&](const auto& model) { return model->text == text; });
  if (known != last_.end()) {
    readings_[key] = {*known};
    return false;
  }
  {
    const std::lock_guard lock(mutex_);
    job_ = Job{run_, key, text, read_model_};
  }
  wake_.notify_one();
  return true;
}

std::optional<ModelTexts::Key> ModelTexts::collect() {
  std::optional<Job> done;
  {
    const std::lock_guard lock(mutex_);
    if (job_ && job_->reading) done = std::exchange(job_, std::nullopt);
  }
  if (!done || done->run != run_) return std::nullopt;
  keep(done->key, *done->reading);
  return done->key;
}

const ModelTexts::Reading* ModelTexts::find(const Key& key) const {
  const auto found = readings_.find(key);
  return found == readings_.end() ? nullptr : &found->second;
}

void ModelTexts::keep(const Key& key, const Reading& reading) {
  readings_[key] = reading;
  if (reading.model == nullptr) return;
  last_.push_front(reading.model);
  if (last_.size() > most_readings) last_.pop_back();
}

void ModelTexts::read_texts() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return ends_ || (job_ && !job_->reading); });
    if (ends_) return;
    const Job job = *job_;
    lock.unlock();
    Reading reading = read(job);
    lock.lock();
    job_->reading = std::move(reading);
    lock.unlock();
    on_read_();
    lock.lock();
  }
}

ModelTexts::Reading ModelTexts::read(const Job& job) {
  const auto began = std::chrono::steady_clock::now();
  const auto took = [&] { return std::chrono::steady_clock::now() - began; };
  try {
    if (!job.read_model)
      return {nullptr, ResultCode::feature_unsupported, "this experiment does not accept models as text"};
    description::ParsedModelPtr model = job.read_model(job.text);
    return {std::move(model), ResultCode::ok, "", took()};
  } catch (const description::ModelTextError& error) {
    return {nullptr, error.lacks_file ? ResultCode::missing_assets : ResultCode::resource_parse_error, error.what(),
            took()};
  } catch (const std::exception& error) {
    return {nullptr, ResultCode::operation_failed, error.what(), took()};
  }
}

}  // namespace cohort::session
