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
  std::string unit{};  ///< SI, `1` if dimensionless; empty of what has none
};

/// Takes the rows of one table, in their order.
class TableWriter {
 public:
  TableWriter() = default;
  TableWriter(const TableWriter&) = delete;
  TableWriter& operator=(const TableWriter&) = delete;
  virtual ~TableWriter() = default;

  /// A cell for each column, of its type. Throws WriteError if it cannot be written.
  virtual void add(std::span<const Cell> row) = 0;
  /// After the last row: all of it is in the file. Throws std::runtime_error if it is not.
  virtual void finish() = 0;
};

/// Where tables go.
class TableSink {
 public:
  TableSink() = default;
  TableSink(const TableSink&) = delete;
  TableSink& operator=(const TableSink&) = delete;
  virtual ~TableSink() = default;

  /// Begins a table. The writer must be gone before this is. Throws std::runtime_error.
  virtual std::unique_ptr<TableWriter> begin(const std::string& name, const std::vector<Column>& columns) = 0;
  /// All tables are written, and their writers gone. Without it what was there before is there still. Throws
  /// std::runtime_error.
  virtual void finish() = 0;
};

}  // namespace cohort::data
