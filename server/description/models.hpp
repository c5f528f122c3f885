// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "server/description/model.hpp"

namespace cohort::description {

/// The models of a world. The address of a model does not change when models are added. Copies of a list share the
/// models that neither has edited, so that many worlds of one experiment need no more memory for models than one.
class Models {
 public:
  class Iterator {
   public:
    using iterator_category = std::random_access_iterator_tag;
    using value_type = Model;
    using difference_type = std::ptrdiff_t;
    using pointer = const Model*;
    using reference = const Model&;

    Iterator() = default;
    explicit Iterator(const std::shared_ptr<Model>* at) : at_(at) {}
    reference operator*() const { return **at_; }
    pointer operator->() const { return at_->get(); }
    reference operator[](difference_type i) const { return *at_[i]; }
    Iterator& operator+=(difference_type i) {
      at_ += i;
      return *this;
    }
    Iterator& operator-=(difference_type i) { return *this += -i; }
    Iterator& operator++() { return *this += 1; }
    Iterator& operator--() { return *this -= 1; }
    Iterator operator++(int) { return std::exchange(*this, *this + 1); }
    Iterator operator--(int) { return std::exchange(*this, *this - 1); }
    friend Iterator operator+(Iterator it, difference_type i) { return it += i; }
    friend Iterator operator+(difference_type i, Iterator it) { return it += i; }
    friend Iterator operator-(Iterator it, difference_type i) { return it -= i; }
    friend difference_type operator-(Iterator a, Iterator b) { return a.at_ - b.at_; }
    friend auto operator<=>(const Iterator& a, const Iterator& b) = default;

   private:
    const std::shared_ptr<Model>* at_ = nullptr;
  };

  Models() = default;
  Models(std::initializer_list<Model> models) {
    for (const Model& model : models) push_back(model);
  }

  std::size_t size() const { return models_.size(); }
  bool empty() const { return models_.empty(); }
  const Model& operator[](std::size_t index) const { return *models_[index]; }
  const Model& at(std::size_t index) const { return *models_.at(index); }
  const Model& front() const { return *models_.front(); }
  const Model& back() const { return *models_.back(); }
  Iterator begin() const { return Iterator(models_.data()); }
  Iterator end() const { return Iterator(models_.data() + models_.size()); }

  void push_back(Model model) { models_.push_back(std::make_shared<Model>(std::move(model))); }
  void pop_back() { models_.pop_back(); }
  void clear() { models_.clear(); }
  /// Returns a model for editing. A model that other lists share is copied first, so its address changes.
  Model& edit(std::size_t index) {
    std::shared_ptr<Model>& model = models_[index];
    if (model.use_count() > 1) model = std::make_shared<Model>(*model);
    return *model;
  }

 private:
  std::vector<std::shared_ptr<Model>> models_;
};

}  // namespace cohort::description
