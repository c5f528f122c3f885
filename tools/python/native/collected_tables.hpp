// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "tools/common/data/table.hpp"

namespace cohort::python {

/// A table in memory: one row-major matrix for each type of column.
struct CollectedTable {
  std::vector<data::Column> columns;
  std::size_t rows = 0;
  std::vector<double> reals{};
  std::vector<std::int64_t> wholes{};
  std::vector<std::int32_t> texts{};       ///< indices into `text_values`
  std::vector<std::string> text_values{};  ///< distinct values, in the order of their first occurrence
};

/// Collects tables. `is_kept` selects by name the tables whose rows are kept. `each_row` is called before each row,
/// kept or not; its exceptions are passed on.
class CollectedTables final : public data::TableSink {
 public:
  CollectedTables(std::function<bool(const std::string& name)> is_kept, std::function<void()> each_row)
      : is_kept_(std::move(is_kept)), each_row_(std::move(each_row)) {}

  std::unique_ptr<data::TableWriter> begin(const std::string& name, const std::vector<data::Column>& columns) override;
  void finish() override {}

  /// Returns all tables by name.
  std::map<std::string, CollectedTable>& tables() { return tables_; }

 private:
  std::function<bool(const std::string& name)> is_kept_;
  std::function<void()> each_row_;
  std::map<std::string, CollectedTable> tables_;
};

}  // namespace cohort::python
