// SPDX-License-Identifier: BSL-1.0
#include "described.hpp"

#include <fmt/format.h>

namespace nysalt::program {

void name_infinities(json& document) {
  if (document.is_structured()) {
    for (json& one : document) name_infinities(one);
  } else if (document.is_number_float() && std::isinf(document.get<double>())) {
    document = document > 0.0 ? "infinite" : "-infinite";
  }
}

namespace {

void add_cells(const json& value, const json& schema, const std::string& name, table_row& row) {
  if (schema.contains("properties")) {
    for (const auto& [member, of_member] : schema["properties"].items()) {
      add_cells(value.is_null() ? json() : value.at(member), of_member,
                name.empty() ? member : fmt::format("{}.{}", name, member), row);
    }
    return;
  }
  std::string cell;
  if (schema.contains("items")) {
    if (schema["items"] != schema_of<std::string>()) return;
    for (const json& one : value) {
      if (!cell.empty()) cell += ",";
      cell += one.get<std::string>();
    }
  } else if (value.is_string()) {
    cell = value.get<std::string>();
  } else if (const std::string number = value.dump(); number != "null") {
    cell = number;
  }
  row.names.push_back(name);
  row.cells.push_back(cell);
}

}  // namespace

table_row row_of_table(const json& document, const json& schema) {
  table_row row;
  add_cells(document, schema, "", row);
  return row;
}

}  // namespace nysalt::program
