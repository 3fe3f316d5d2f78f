// SPDX-License-Identifier: BSL-1.0
// Structs described once, by the list of their members. Documents, work files, the columns of tables, the
// records of Python and JSON Schema files are made from the lists.
#pragma once

#include <algorithm>
#include <array>
#include <boost/preprocessor/seq/enum.hpp>
#include <boost/preprocessor/seq/transform.hpp>
#include <boost/preprocessor/stringize.hpp>
#include <boost/preprocessor/variadic/to_seq.hpp>
#include <cmath>
#include <concepts>
#include <functional>
#include <limits>
#include <optional>
#include <ranges>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "json.hpp"

namespace nysalt::program {

/// Argument that selects the list of a struct: members(of<T>()) is a std::tuple of `item`.
template <class T>
struct of {};

/// A member of a document. `get` is a data member, or a function of the struct; the result of a function is
/// written and not read.
template <class Get>
struct item {
  constexpr item(const char* as, Get getter) : name(as), get(getter) {}
  const char* name;
  Get get;
};

#define NYSALT_NAMED(r, T, name) ::nysalt::program::item(BOOST_PP_STRINGIZE(name), &T::name)
// The members of T of these names, separated by commas: a part of a list.
#define NYSALT_MEMBERS(T, ...) \
  BOOST_PP_SEQ_ENUM(BOOST_PP_SEQ_TRANSFORM(NYSALT_NAMED, T, BOOST_PP_VARIADIC_TO_SEQ(__VA_ARGS__)))
// The whole list of T, in namespace nysalt::program.
#define NYSALT_DESCRIBED(T, ...) \
  constexpr auto members(of<T>) { return std::tuple(NYSALT_MEMBERS(T, __VA_ARGS__)); }

template <class T>
concept described = requires { members(of<T>()); };

/// Calls see(member) for each member of T, in their order.
template <described T>
constexpr void for_each_member(const auto& see) {
  std::apply([&](const auto&... all) { (see(all), ...); }, members(of<T>()));
}

/// The document of a T, as it was made or read.
template <class T>
struct kept {
  json document{};
};

namespace kind_of {

template <class T>
constexpr bool is_kept = false;
template <class T>
constexpr bool is_kept<kept<T>> = true;

template <class T>
constexpr bool is_optional = false;
template <class T>
constexpr bool is_optional<std::optional<T>> = true;

template <class T>
concept text = std::convertible_to<T, std::string_view>;
/// Pairs of a name and a value, which are an object in JSON.
template <class T>
concept object =
    std::ranges::range<T> && !std::same_as<T, json> && requires(const std::ranges::range_value_t<T>& one) {
      { one.first } -> text;
      one.second;
    };
template <class T>
concept list = std::ranges::range<T> && !text<T> && !object<T> && !std::same_as<T, json>;

}  // namespace kind_of

/// The value, or nothing where it does not hold.
template <class T>
std::optional<T> only_if(bool holds, const T& value) {
  return holds ? std::optional(value) : std::nullopt;
}

template <described T>
void add_members(json& document, const T& value);

/// The document of a value. An optional without a value and an empty text are null, and so is a number that
/// is not finite when the document is written.
template <class T>
json as_json(const T& value) {
  if constexpr (described<T>) {
    json result = json::object();
    add_members(result, value);
    return result;
  } else if constexpr (kind_of::is_kept<T>) {
    return value.document;
  } else if constexpr (kind_of::is_optional<T>) {
    return value ? as_json(*value) : json();
  } else if constexpr (std::is_enum_v<T>) {
    return as_json(to_string(value));
  } else if constexpr (kind_of::text<T>) {
    const std::string_view characters(value);
    return characters.empty() ? json() : json(characters);
  } else if constexpr (kind_of::object<T>) {
    json result = json::object();
    for (const auto& [name, one] : value) result[name] = as_json(one);
    return result;
  } else if constexpr (kind_of::list<T>) {
    json result = json::array();
    for (const auto& one : value) result.push_back(as_json(one));
    return result;
  } else {
    return json(value);
  }
}

template <described T>
void add_members(json& document, const T& value) {
  for_each_member<T>(
      [&](const auto& member) { document[member.name] = as_json(std::invoke(member.get, value)); });
}

/// Reads what as_json() made, with infinities() for numbers that are not finite. Throws std::exception for
/// what has not the members, types and lengths of T, and where require_whole(into) of T does.
template <class T>
void read_json(const json& from, T& into) {
  if constexpr (described<T>) {
    for_each_member<T>([&]<class Get>(const item<Get>& member) {
      if constexpr (std::is_member_object_pointer_v<Get>) read_json(from.at(member.name), into.*member.get);
    });
    if constexpr (requires { require_whole(into); }) require_whole(into);
  } else if constexpr (std::same_as<T, json>) {
    into = from;
  } else if constexpr (kind_of::is_kept<T>) {
    into.document = from;
  } else if constexpr (kind_of::is_optional<T>) {
    into.reset();
    if (!from.is_null()) read_json(from, into.emplace());
  } else if constexpr (std::same_as<T, double>) {
    const double infinity = std::numeric_limits<double>::infinity();
    into = from.is_null()        ? std::numeric_limits<double>::quiet_NaN()
           : from == "infinite"  ? infinity
           : from == "-infinite" ? -infinity
                                 : from.get<double>();
  } else if constexpr (std::same_as<T, std::string>) {
    into = from.is_null() ? std::string() : from.get<std::string>();
  } else if constexpr (kind_of::object<T>) {
    if (!from.is_object()) throw std::out_of_range("object");
    into.clear();
    for (const auto& [name, one] : from.items()) read_json(one, into.emplace_back(name, 0).second);
  } else if constexpr (kind_of::list<T>) {
    if (!from.is_array()) throw std::out_of_range("list");
    if constexpr (requires { into.resize(from.size()); }) into.resize(from.size());
    if (into.size() != from.size()) throw std::out_of_range("list");
    for (std::size_t k = 0; k < into.size(); ++k) read_json(from[k], into[k]);
  } else {
    from.get_to(into);
  }
}
template <class T>
T from_json(const json& document) {
  T result{};
  read_json(document, result);
  return result;
}

/// Puts "infinite" or "-infinite" where a document has such a number, for which JSON has none.
void name_infinities(json& document);

/// The JSON Schema of the documents of T.
template <class T>
json schema_of();

namespace kind_of {

template <class T>
json schema_of_kept(const kept<T>&) {
  return schema_of<T>();
}

}  // namespace kind_of

template <class T>
json schema_of() {
  const auto type = [](auto... names) { return json{{"type", json::array({names...})}}; };
  if constexpr (described<T>) {
    json properties = json::object();
    json required = json::array();
    for_each_member<T>([&](const auto& member) {
      using value = std::remove_cvref_t<std::invoke_result_t<decltype(member.get), const T&>>;
      properties[member.name] = schema_of<value>();
      required.push_back(member.name);
    });
    return {{"type", json::array({"object"})},
            {"properties", properties},
            {"required", required},
            {"additionalProperties", false}};
  } else if constexpr (std::same_as<T, json>) {
    return json::object();
  } else if constexpr (kind_of::is_kept<T>) {
    return kind_of::schema_of_kept(T());
  } else if constexpr (kind_of::is_optional<T>) {
    json result = schema_of<typename T::value_type>();
    if (json& types = result["type"]; std::ranges::find(types, "null") == types.end())
      types.push_back("null");
    return result;
  } else if constexpr (std::is_enum_v<T>) {
    return type("string");
  } else if constexpr (kind_of::text<T>) {
    return type("string", "null");
  } else if constexpr (kind_of::object<T>) {
    json result = type("object");
    result["additionalProperties"] = schema_of<decltype(std::ranges::range_value_t<T>::second)>();
    return result;
  } else if constexpr (kind_of::list<T>) {
    json result = type("array");
    result["items"] = schema_of<std::ranges::range_value_t<T>>();
    return result;
  } else if constexpr (std::same_as<T, bool>) {
    return type("boolean");
  } else if constexpr (std::integral<T>) {
    return type("integer");
  } else {
    static_assert(std::same_as<T, double>);
    return type("number", "null");
  }
}

/// Of all documents; it rises when a member goes, or means something else.
inline constexpr int version_of_documents = 1;

/// The document of a command, which states its version, and its schema.
template <described T>
json whole_document(const T& value) {
  json document{{"version", version_of_documents}};
  add_members(document, value);
  return document;
}
template <described T>
json whole_schema(const std::string& title) {
  json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
  schema.update(schema_of<T>());
  schema["properties"]["version"] = {{"const", version_of_documents}};
  schema["required"].push_back("version");
  return schema;
}

/// Names and cells of a row of a table, of an object and its schema: members of members have a point between
/// their names, lists of texts a comma between the texts; other lists stand in documents alone.
struct table_row {
  std::vector<std::string> names;
  std::vector<std::string> cells;
};
table_row row_of_table(const json& document, const json& schema);

}  // namespace nysalt::program
