// SPDX-License-Identifier: BSL-1.0
// The tables of a comparison, as the terminal and the report show them.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "comparison/ranking.hpp"
#include "table.hpp"

namespace nysalt::program {

/// Of this process so far, in bytes.
std::int64_t peak_memory();

/// The label of the values of a metric, on axes.
std::string quantity(const comparison& all, std::size_t metric);

/// What errors of a metric are called in sentences.
std::string errors_compared(const comparison& all, std::size_t metric);
/// Who is best at which cost in evaluations, in a sentence or two; names are between backquotes.
std::string verdict_by_evaluations(const comparison& all, std::size_t metric);
/// The same without backquotes.
std::string plain_verdict(const comparison& all, std::size_t metric);

/// The marks of a finding, joined by commas.
std::string joined_marks(const comparison& all, std::size_t metric, const row& line);

/// What matters of the rows of a metric, those first that are best at their cost, those last that are not
/// ranked.
table ranking_of(const comparison& all, std::size_t metric);

/// The rows of a metric, and what costs nothing: null model and floor.
table rows_of(const comparison& all, std::size_t metric);
std::vector<std::pair<std::string, double>> free_of_cost(const comparison& all, std::size_t metric);
/// Reference, null model and floor or horizon, over the steps that share a reference.
table baselines_of(const comparison& all, std::size_t metric);
table equal_cost_table(const comparison& all, std::size_t metric);

/// How evaluations are counted where parts of the force have prices.
std::string sentence_of_prices(const std::vector<double>& prices);
/// One sentence for each mark that is there, and for each row without a value.
std::vector<std::string> meanings_of_marks(const comparison& all, std::size_t metric);
std::vector<std::string> reasons_of(const comparison& all, std::size_t metric);
/// One sentence for each frequency that methods are fitted to, and for each reason why methods of the list
/// are left out.
std::vector<std::string> sentences_of_methods(const comparison& all);
}  // namespace nysalt::program
