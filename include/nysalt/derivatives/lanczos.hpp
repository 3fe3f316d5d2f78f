// SPDX-License-Identifier: BSL-1.0
// Both ends of a symmetric spectrum, from products with vectors only.
#pragma once

#include <Eigen/Core>

#include <functional>

namespace nysalt {

/// Both ends of a spectrum, with approximate eigenvectors.
struct spectrum_ends {
  double lowest;                      ///< a bound from below of the lowest eigenvalue found
  double highest;                     ///< a bound from above of the highest eigenvalue found
  Eigen::VectorXd lowest_direction;   ///< the Ritz vector of the lowest, of length 1
  Eigen::VectorXd highest_direction;  ///< the Ritz vector of the highest, of length 1
  int products;                       ///< applications of the map
};

/// A symmetric map v -> A v.
using symmetric_map = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

/// The ends of the spectrum of A, from a start with a part in every direction [lanczos_1950]. Each
/// end is a Ritz value moved outwards by its residual, so that it bounds the eigenvalue that it belongs to;
/// of many close ones that may be another than the last, less than the error away. It stops when the
/// residuals are below relative_error of the highest end (or of 1 % of the lowest, if that is larger in size)
/// and of the larger of both; after 100 products they are what they are. Unlike power iteration it needs no
/// shift where negative ends are larger in size than positive ones. Both ends are NaN if a product is not
/// finite. Cost: some 8 to 40 products, and k^2 dot products for k.
spectrum_ends ends_of_spectrum(const symmetric_map& multiply, const Eigen::VectorXd& start,
                               double relative_error = 0.01);

}  // namespace nysalt
