// SPDX-License-Identifier: BSL-1.0
// Several measures as one.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "nysalt/analysis/error_measure.hpp"

namespace nysalt {

/// Several measures that read the same states: the numbers of all lie one after the other.
class joined_measures {
 public:
  /// All of them, or only those that need a reference: of the others then nothing is read.
  enum class which { all, of_reference };

  /// Refers to the measures.
  explicit joined_measures(std::span<const error_measure> measures, which wanted = which::all)
      : measures_(measures) {
    for (const error_measure& measure : measures) {
      const bool counts = wanted == which::all || measure.needs_reference;
      begins_.push_back(begins_.back() + (counts ? measure.width : 0));
    }
  }

  std::size_t size() const { return measures_.size(); }                          ///< number of measures
  const error_measure& operator[](std::size_t i) const { return measures_[i]; }  ///< measure i
  /// Number of values that are read of a state.
  std::size_t width() const { return begins_.back(); }
  /// Whether anything is read for measure i.
  bool reads(std::size_t i) const { return begins_[i + 1] > begins_[i]; }

  /// Writes all width() numbers of a state.
  template <class T>
  void read(const phase_point<T, Eigen::Dynamic>& x, std::span<T> result) const {
    for (std::size_t i = 0; i < size(); ++i) {
      if (reads(i)) measures_[i].read(x, result.subspan(begins_[i], begins_[i + 1] - begins_[i]));
    }
  }
  /// The numbers of measure i among all of a state.
  template <class T>
  std::span<const T> part(std::size_t i, std::span<const T> all) const {
    return all.subspan(begins_[i], begins_[i + 1] - begins_[i]);
  }

 private:
  std::span<const error_measure> measures_;
  std::vector<std::size_t> begins_{0};  // and where the last ends
};

}  // namespace nysalt
