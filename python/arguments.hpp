// SPDX-License-Identifier: BSL-1.0
// The keyword arguments of a call, as the commands take them: what is None is left as it is. And texts as
// Python shows and takes them.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../src/program/settings.hpp"

namespace nysalt::python {

/// As Python shows it, in one line of moderate length.
std::string shown(const pybind11::handle& value);
/// Texts that a call returns, such as warnings.
pybind11::list list_of(const std::vector<std::string>& texts);

class argument_reader {
 public:
  explicit argument_reader(pybind11::dict arguments) : arguments_(std::move(arguments)) {}

  bool has(const char* name) const { return arguments_.contains(name) && !arguments_[name].is_none(); }
  pybind11::object operator[](const char* name) const { return arguments_[name]; }
  /// A dict of further arguments.
  argument_reader inner(const char* name) const {
    return argument_reader(arguments_[name].cast<pybind11::dict>());
  }
  /// Of those that are not None.
  std::vector<std::string> names() const;

  /// What the rows hold, by the names of their fields. Throws refusal for two of which one excludes the
  /// other.
  void take(const program::option_rows& rows) const;

  // Each throws refusal, naming the argument, for what is of another kind. A list may be a single value.
  // True is no number.
  void take(const char* name, double& to) const;
  void take(const char* name, int& to) const;
  void take(const char* name, std::int64_t& to) const;
  void take(const char* name, std::uint64_t& to) const;
  void take(const char* name, bool& to) const;
  void take(const char* name, std::string& to) const;
  void take(const char* name, std::vector<double>& to) const;
  void take(const char* name, std::vector<std::string>& to) const;
  void take(const char* name, std::map<std::string, std::string>& to) const;
  template <class T>
  void take(const char* name, std::optional<T>& to) const {
    if (has(name)) take(name, to.emplace());
  }

 private:
  pybind11::dict arguments_;
};

/// The keywords of calls by the rows of the commands: (name, type, default, help) in a list, by the command.
pybind11::dict keywords();

/// seed, threads and force; a system that calls Python has one thread.
program::common_settings common_of(const argument_reader& arguments, bool calls_python);
program::system_settings system_of(const argument_reader& arguments);
program::learn_command learn_of(const argument_reader& arguments, const program::system_settings& system);
program::run_command run_of(const argument_reader& arguments, const program::system_settings& system);
program::compare_command compare_of(const argument_reader& arguments, const program::system_settings& system);
program::recommend_command recommend_of(const argument_reader& arguments,
                                        const program::system_settings& system);
sampling_options sampling_of(const argument_reader& arguments, const program::system_settings& system);

}  // namespace nysalt::python
