// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "nysalt/model.hpp"

namespace nysalt::detail {

/// A system in the coordinates q_i/s_i and of unit masses: V(s q').
class rescaled {
 public:
  static constexpr int dimension = Eigen::Dynamic;

  rescaled(model system, Eigen::VectorXd scales) : system_(std::move(system)), scales_(std::move(scales)) {}

  Eigen::Index size() const { return scales_.size(); }
  std::string description() const { return system_.description(); }

  template <class T>
    requires requires(const model& of, const vector<T, dimension>& q, vector<T, dimension>& f) {
      of.force(q, f);
    }
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    vector<T, dimension> whole(q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) whole[i] = q[i] * scales_[i];
    system_.force(whole, f);
    for (Eigen::Index i = 0; i < q.size(); ++i) f[i] = f[i] * scales_[i];
  }
  template <Served T>
  T potential(const vector<T, dimension>& q) const {
    vector<T, dimension> whole(q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) whole[i] = q[i] * scales_[i];
    return system_.potential(whole);
  }

 private:
  model system_;
  Eigen::VectorXd scales_;
};

}  // namespace nysalt::detail
