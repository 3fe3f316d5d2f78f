// SPDX-License-Identifier: BSL-1.0
// Where the searches of a fit start, and what is asked of them.
#pragma once

#include <optional>
#include <vector>

#include "nysalt/communicator.hpp"
#include "nysalt/derivatives/spectrum.hpp"
#include "nysalt/family.hpp"
#include "problem.hpp"
#include "search.hpp"

namespace nysalt::detail {

/// The mean over frequencies of the bands of |M - R|^2 in coordinates (omega q, p), M the matrix of one step
/// and R that of the exact flow; nothing for words with rotations, which are exact on their modes. Its minima
/// are starts of a search where the step is so large that no trajectory from elsewhere stays finite. Cost:
/// some microseconds.
objective oscillator_loss(const family& family, const std::vector<frequency_band>& bands, double step);

/// Puts in the values of parameters that are not to be learned.
void fix(const fit_options& options, Eigen::VectorXd& theta);

/// The numbers of the parameters that are to be learned.
std::vector<Eigen::Index> free_parameters(const nysalt::family& family, const fit_options& options);

/// The starts of the family or the start that was asked for, further starts, and random ones. Of `problem`
/// only what is known of the system and the data counts.
std::vector<named_parameters> starts_of(const nysalt::family& family, const fit_options& options,
                                        const learning_problem& problem,
                                        const std::vector<Eigen::Index>& free);

/// For a search, of little effort, in a family that another one contains; nothing where the values of fixed
/// parameters are not those of a member of the smaller family.
std::optional<fit_options> options_within(const contained_family& inner, const fit_options& options);

/// The same task, of a larger family, among the members of one that it contains. The kept starts and the
/// most stable member are of the smaller family.
search_task within(const contained_family& inner, search_task task);

/// Ranks search each by itself with the same sums. They would not take the same steps if their processors'
/// libraries differed in a bit. Throws std::runtime_error at all ranks then.
void require_same(const communicator& ranks, const Eigen::VectorXd& theta);

/// Throws std::invalid_argument for options that the family cannot take.
void require_sound(const nysalt::family& family, const fit_options& options);

}  // namespace nysalt::detail
