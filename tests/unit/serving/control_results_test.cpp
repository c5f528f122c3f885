// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdint>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "client_sdk/src/control/control_values.hpp"
#include "idl/wire/control_messages.hpp"
#include "tests/support/files.hpp"

// The codes of refusals, and the tables of docs/protocol.md that list them.
namespace cohort::wire {
namespace {

using Codes = std::set<std::pair<std::uint32_t, std::string>>;

// Returns the enumerators of an enumeration, with spaces for underscores.
Codes codes_of(const std::string& enumeration, const std::string& header) {
  const std::string text = test::read_file(COHORT_SOURCE_DIR "/" + header);
  const std::size_t begin = text.find("enum class " + enumeration + " ");
  const std::string body = text.substr(begin, text.find("};", begin) - begin);
  const std::regex enumerator(R"((\w+) = (\d+),)");
  Codes codes;
  for (std::sregex_iterator match(body.begin(), body.end(), enumerator), end; match != end; ++match)
    codes.emplace(std::stoul((*match)[2]), std::regex_replace((*match)[1].str(), std::regex("_"), " "));
  return codes;
}

// A row of a table: | CODE NAME | MINOR | MEANING |.
struct Row {
  std::uint32_t code;
  std::string name;
  std::uint32_t minor;
};
std::vector<Row> rows_of(const std::string& column) {
  const std::regex pattern(R"(\| (\d+) ([a-z ]+) \| (\d+) \| .+ \|)");
  std::vector<Row> rows;
  bool is_in_table = false;
  for (const std::string& line : test::lines_of(test::read_file(COHORT_SOURCE_DIR "/docs/protocol.md"))) {
    is_in_table = line.starts_with("| `" + column + "` |") || (is_in_table && line.starts_with("|"));
    std::smatch parts;
    if (is_in_table && std::regex_match(line, parts, pattern))
      rows.push_back({static_cast<std::uint32_t>(std::stoul(parts[1])), parts[2],
                      static_cast<std::uint32_t>(std::stoul(parts[3]))});
  }
  return rows;
}
Codes codes_of(const std::vector<Row>& rows) {
  Codes codes;
  for (const Row& row : rows) codes.emplace(row.code, row.name);
  return codes;
}

TEST(ControlResults, ArePreciselyThoseOfTheProtocolPage) {
  EXPECT_EQ(codes_of(rows_of("result")), codes_of("ResultCode", "idl/wire/control_messages.hpp"));
  EXPECT_EQ(codes_of(rows_of("status")), codes_of("AdmitStatus", "idl/wire/messages.hpp"));
}

TEST(ControlResults, AreSentOnlyToClientsWhoseMinorVersionHasThem) {
  for (const Row& row : rows_of("result")) {
    const auto result = static_cast<ResultCode>(row.code);
    EXPECT_EQ(known_to(row.minor, result), result) << row.name;
    if (row.minor == 0) continue;
    EXPECT_EQ(known_to(row.minor - 1, result),
              result == ResultCode::time_not_held ? ResultCode::incorrect_state : ResultCode::operation_failed)
        << row.name;
  }
  for (const Row& row : rows_of("status")) {
    const auto status = static_cast<AdmitStatus>(row.code);
    EXPECT_EQ(known_to(row.minor, status), status) << row.name;
    if (row.minor == 0) continue;
    EXPECT_EQ(known_to(row.minor - 1, status), AdmitStatus::refused) << row.name;
  }
}

TEST(ControlResults, HaveAReasonForProgramsAndAnUnknownOneIsAFailure) {
  for (const Row& row : rows_of("result")) {
    if (row.name == "ok" || row.name == "operation failed") continue;
    EXPECT_NE(from_wire(static_cast<ResultCode>(row.code), OperationCode::spawn_entity),
              ControlResult::operation_failed)
        << row.name;
  }
  EXPECT_EQ(from_wire(static_cast<ResultCode>(4711), OperationCode::spawn_entity), ControlResult::operation_failed);
}

}  // namespace
}  // namespace cohort::wire
