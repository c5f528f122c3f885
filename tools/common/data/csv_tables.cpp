// SPDX-License-Identifier: Apache-2.0
#include "tools/common/data/csv_tables.hpp"

#include <charconv>
#include <system_error>

#include "server/core/atomic_file.hpp"

namespace cohort::data {
namespace {

void append(std::string& line, double value) {
  char text[32];
  line.append(std::begin(text), std::to_chars(std::begin(text), std::end(text), value).ptr);
}
void append(std::string& line, std::uint64_t value) { line += std::to_string(value); }
void append(std::string& line, const std::string& text) { line += csv_cell(text); }

class CsvTable final : public TableWriter {
 public:
  CsvTable(const std::filesystem::path& file, const std::vector<Column>& columns) : file_("the table", file) {
    for (const Column& column : columns) {
      if (!line_.empty()) line_ += ',';
      append(line_, column.name);
    }
    end_line();
  }

  void add(std::span<const Cell> row) override {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) line_ += ',';
      std::visit([&](const auto& value) { append(line_, value); }, row[i]);
    }
    end_line();
  }

  void finish() override {
    write();
    file_.commit();
  }

 private:
  void end_line() {
    line_ += '\n';
    constexpr std::size_t written_at_once = 1 << 16;
    if (line_.size() >= written_at_once) write();
  }
  void write() {
    file_.write(line_);
    line_.clear();
  }

  AtomicFile file_;
  std::string line_;  // lines that are not written yet
};

class CsvTables final : public TableSink {
 public:
  explicit CsvTables(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) refuse_to_write("the folder " + folder_.string() + " cannot be created", error.value());
  }
  std::unique_ptr<TableWriter> begin(const std::string& name, const std::vector<Column>& columns) override {
    std::string units;
    for (const Column& column : columns)
      if (!column.unit.empty())
        units += (units.empty() ? "" : ", ") + in_json(column.name) + ": " + in_json(column.unit);
    units_ += (units_.empty() ? "" : ",\n") + std::string("  ") + in_json(name) + ": {" + units + "}";
    return std::make_unique<CsvTable>(folder_ / (name + ".csv"), columns);
  }
  // The tables are whole by themselves.
  void finish() override {
    AtomicFile file("the units of the tables", folder_ / "units.json");
    file.write("{\n" + units_ + "\n}\n");
    file.commit();
  }

 private:
  static std::string in_json(const std::string& text) {
    std::string quoted = "\"";
    for (const char letter : text) {
      if (letter == '"' || letter == '\\') quoted += '\\';
      quoted += letter;
    }
    return quoted + "\"";
  }

  std::filesystem::path folder_;
  std::string units_;  // a line for each table
};

}  // namespace

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char letter : text) cell += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  return cell + "\"";
}

std::unique_ptr<TableSink> csv_tables(const std::filesystem::path& folder) {
  return std::make_unique<CsvTables>(folder);
}

}  // namespace cohort::data
