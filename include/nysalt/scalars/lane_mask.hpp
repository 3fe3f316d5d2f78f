// SPDX-License-Identifier: BSL-1.0
// A set of lanes of a pack.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>

#include "nysalt/scalars/native_vector.hpp"

namespace nysalt {

/// Mask of lanes, the result of comparing packs. Not a bool, as lanes may differ.
template <int W>
class lane_mask {
 public:
  static constexpr int lanes = W;                              ///< W, of the packs that were compared
  static constexpr int of_part = detail::lanes_of_part(W);     ///< lanes in a register of the target
  using part = typename detail::native_vector<of_part>::mask;  ///< a register: of a lane all bits, or none

  lane_mask() = default;
  /// All lanes, or none.
  explicit lane_mask(bool all) {
    for (int lane = 0; lane < W; ++lane) set(lane, all);
  }

  /// Whether the mask has lane 0 <= lane < W; not checked.
  bool operator[](int lane) const {
    if constexpr (of_part == 1) {
      return parts[static_cast<std::size_t>(lane)] != 0;
    } else {
      return parts[static_cast<std::size_t>(lane / of_part)][lane % of_part] != 0;
    }
  }
  /// Takes lane 0 <= lane < W in or out; not checked.
  void set(int lane, bool value) {
    if constexpr (of_part == 1) {
      parts[static_cast<std::size_t>(lane)] = value ? -1 : 0;
    } else {
      parts[static_cast<std::size_t>(lane / of_part)][lane % of_part] = value ? -1 : 0;
    }
  }

  /// Lanes that are in both. There is no &&, which would have to leave out its second operand.
  friend lane_mask operator&(const lane_mask& a, const lane_mask& b) {
    lane_mask result;
    for (std::size_t i = 0; i < a.parts.size(); ++i) result.parts[i] = a.parts[i] & b.parts[i];
    return result;
  }
  /// Lanes that are in a, in b or in both.
  friend lane_mask operator|(const lane_mask& a, const lane_mask& b) {
    lane_mask result;
    for (std::size_t i = 0; i < a.parts.size(); ++i) result.parts[i] = a.parts[i] | b.parts[i];
    return result;
  }
  /// All other lanes.
  friend lane_mask operator!(const lane_mask& a) {
    lane_mask result;
    for (std::size_t i = 0; i < a.parts.size(); ++i) result.parts[i] = !a.parts[i];
    return result;
  }

  /// `if (x < y)` of a system means one branch for all lanes, which there is not.
  template <class T = bool>
  operator bool() const {
    static_assert(!std::same_as<T, bool>,
                  "nysalt: lanes may differ in a comparison, so it cannot choose a branch: write "
                  "nysalt::select(condition, a, b), or let the system say `static constexpr int lanes = 1;`");
    return false;
  }

  std::array<part, W / of_part> parts;  ///< lane k is in parts[k / of_part]
};

/// Whether the mask has any lane.
template <int W>
bool any(const lane_mask<W>& which) {
  auto some = which.parts[0];
  for (const auto& part : which.parts) some = some | part;
  if constexpr (lane_mask<W>::of_part == 1) {
    return some != 0;
  } else {
    bool result = false;
    for (int lane = 0; lane < lane_mask<W>::of_part; ++lane) result = result || some[lane] != 0;
    return result;
  }
}

}  // namespace nysalt
