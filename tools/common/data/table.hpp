// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

/// Tables of a recording for other programs: one row for each observation, one column for each variable.
namespace cohort::data {

using Cell = std::variant<double, std::uint64_t, std::string>;

struct Column {
  enum class Type { real, whole, text };
  std::string name;
  Type type = Type::real;
  std::string unit{};  ///< SI, `1` if dimensionless; empty: not a quantity
};

/// Writes the rows of one table, in order.
class TableWriter {
 public:
  TableWriter() = default;
  TableWriter(const TableWriter&) = delete;
  TableWriter& operator=(const TableWriter&) = delete;
  virtual ~TableWriter() = default;

  /// Adds a row with a cell for each column, of the column's type. Throws WriteError if it cannot be written.
  virtual void add(std::span<const Cell> row) = 0;
  /// Completes the table after the last row. Throws std::runtime_error if not all rows could be written.
  virtual void finish() = 0;
};

/// A destination of tables.
class TableSink {
 public:
  TableSink() = default;
  TableSink(const TableSink&) = delete;
  TableSink& operator=(const TableSink&) = delete;
  virtual ~TableSink() = default;

  /// Begins a table. The writer must be destroyed before this. Throws std::runtime_error.
  virtual std::unique_ptr<TableWriter> begin(const std::string& name, const std::vector<Column>& columns) = 0;
  /// Completes the output, after all writers were destroyed. Without this call, the former output is kept. Throws
  /// std::runtime_error.
  virtual void finish() = 0;
};

}  // namespace cohort::data
