// SPDX-License-Identifier: BSL-1.0
// The style of a curve: in colour, in grey and for the colour-blind, so that no meaning is in the colour
// only.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "figure.hpp"

namespace nysalt::detail {

struct curve_style {
  const char* colour;
  int point;  // filled; the hollow one of the same shape is the number below
  const char* dash;
  double width;
  double size;
};

bool has_hollow(const curve& one);

/// What is emphasised is solid and thick, the others are thin and of five dashes.
curve_style style_of(const panel& plot, std::size_t j);

/// The elements of a plot command that draw a curve, without its entry in the key.
std::vector<std::string> drawing_of(const panel& plot, std::size_t j, const std::string& data);

std::string key_entry(const panel& plot, std::size_t j);

/// The style of the bands of a label: the first light and without a border, the next dark with one.
std::string style_of_intervals(std::size_t label);

/// Numbers of labels, in the order of their first bands.
std::vector<std::string> labels_of_intervals(const panel& plot);

}  // namespace nysalt::detail
