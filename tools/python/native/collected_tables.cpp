// SPDX-License-Identifier: Apache-2.0
#include "tools/python/native/collected_tables.hpp"

#include <span>
#include <utility>
#include <variant>

namespace cohort::python {
namespace {

class CollectedRows final : public data::TableWriter {
 public:
  CollectedRows(CollectedTable* table, const std::function<void()>& each_row) : table_(table), each_row_(each_row) {}

  void add(std::span<const data::Cell> row) override {
    each_row_();
    if (table_ == nullptr) return;
    for (const data::Cell& cell : row) std::visit([this](const auto& value) { append(value); }, cell);
    ++table_->rows;
  }
  void finish() override {}

 private:
  void append(double value) { table_->reals.push_back(value); }
  void append(std::uint64_t value) { table_->wholes.push_back(static_cast<std::int64_t>(value)); }
  void append(const std::string& text) {
    const auto [known, is_new] = places_.try_emplace(text, static_cast<std::int32_t>(places_.size()));
    if (is_new) table_->text_values.push_back(text);
    table_->texts.push_back(known->second);
  }

  CollectedTable* table_;  // null: skip rows
  const std::function<void()>& each_row_;
  std::unordered_map<std::string, std::int32_t> places_;
};

}  // namespace

std::unique_ptr<data::TableWriter> CollectedTables::begin(const std::string& name,
                                                          const std::vector<data::Column>& columns) {
  CollectedTable& table = tables_[name];
  table.columns = columns;
  return std::make_unique<CollectedRows>(is_kept_(name) ? &table : nullptr, each_row_);
}

}  // namespace cohort::python
