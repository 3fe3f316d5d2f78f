// SPDX-License-Identifier: BSL-1.0
// The name of a type as it is written in C++.
#pragma once

#include <cxxabi.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <typeinfo>

namespace nysalt::detail {

/// With the namespaces that have a name.
inline std::string name_of_type(const std::type_info& type) {
  int failure = 0;
  const std::unique_ptr<char, void (*)(void*)> readable(
      abi::__cxa_demangle(type.name(), nullptr, nullptr, &failure), std::free);
  std::string name = readable ? readable.get() : type.name();
  constexpr std::string_view unnamed = "(anonymous namespace)::";
  for (auto at = name.find(unnamed); at != std::string::npos; at = name.find(unnamed)) {
    name.erase(at, unnamed.size());
  }
  return name;
}

}  // namespace nysalt::detail
