// SPDX-License-Identifier: BSL-1.0
#include "origin.hpp"

#include <fmt/format.h>

#include <boost/crc.hpp>
#include <cmath>

#include "build_info.hpp"

namespace nysalt::program {

namespace {

std::string crc_of_functions() {
  boost::crc_32_type sum;
  const auto add = [&](double value) { sum.process_bytes(&value, sizeof value); };
  constexpr int arguments = 2000;  // code for another processor rounds at one of some thousand otherwise
  for (int i = 1; i <= arguments; ++i) {
    const double x = (i + 0.1) / (arguments + 1.0);  // within (0, 1)
    for (const double value :
         {std::exp(7.0 * x),  std::exp2(5.0 * x),         std::expm1(x),      std::log(9.0 * x),
          std::log2(5.0 * x), std::log10(5.0 * x),        std::log1p(x),      std::sin(9.0 * x),
          std::cos(9.0 * x),  std::tan(9.0 * x),          std::asin(x),       std::acos(x),
          std::atan(4.0 * x), std::atan2(x, 1.3),         std::sinh(5.0 * x), std::cosh(5.0 * x),
          std::tanh(3.0 * x), std::pow(9.0 * x, 5.0 * x), std::cbrt(x),       std::hypot(x, 1.3),
          std::erf(x)}) {
      add(value);
    }
  }
  return fmt::format("{:08x}", sum.checksum());
}

std::string text_in(const json& head, const char* name) {
  const json value = head.value(name, json());
  return value.is_string() ? value.get<std::string>() : std::string();
}

}  // namespace

json origin() {
  static const std::string functions = crc_of_functions();
  return {{"nysalt", version}, {"functions", functions}};
}

std::string warning_of_origin(const json& head, const std::filesystem::path& file) {
  const json here = origin();
  const auto differs = [&](const char* name) {
    const std::string there = text_in(head, name);
    return !there.empty() && there != here.at(name);
  };
  if (differs("nysalt")) {
    return fmt::format("{} was written by nysalt {}, this is {}: what follows may differ in its last digits",
                       file.string(), text_in(head, "nysalt"), version);
  }
  if (differs("functions")) {
    return fmt::format(
        "{} was written on a machine whose C library rounds exp, sin and their like in another way: where "
        "these "
        "are used, what follows may differ in its last digits",
        file.string());
  }
  return {};
}

}  // namespace nysalt::program
