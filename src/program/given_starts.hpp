// SPDX-License-Identifier: BSL-1.0
// Starts that the user gives in the place of the system's own distribution.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

using given_states = std::vector<phase_point<double, Eigen::Dynamic>>;

/// The state that a text says: "x=1,y=0; px=0,py=0.5", by q1, p1, ... or the names of the coordinates, with p
/// before the name of the coordinate for its momentum; 0 where nothing is said. Throws refusal, in the name
/// of
/// --at, for what is no coordinate, is said twice or is not finite.
phase_point<double, Eigen::Dynamic> state_of(const std::string& text,
                                             const std::vector<std::string>& coordinates, Eigen::Index count);

/// Starts at some states, trajectory n at the n-th, and from the first again after the last. With a spread
/// above 0 each with a deviation of its own: the spread times the difference of two states of the law over
/// sqrt(2), which has the law's covariance and the mean 0. Throws refusal if a state does not fit the system.
initial_states starts_at(given_states states, const initial_value_problem& made, double spread);

/// Starts of an output of `run` in arrays, or of a CSV file, which names its columns in the first line and
/// has q1, q2, ... of the system among them, or the names of its coordinates. With momenta p1, p2, ... beside
/// them its rows are states. Without momenta, as `sample` writes it, they are drawn at the temperature. Of an
/// output of `run` the states at one step [the last] are taken. Throws refusal if the file cannot be read,
/// does not fit or has a column that is not known.
initial_states starts_in(const std::string& file, const initial_value_problem& made,
                         const std::vector<std::string>& coordinates, std::optional<std::int64_t> step,
                         double temperature, double spread);

}  // namespace nysalt::program
