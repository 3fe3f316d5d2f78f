// SPDX-License-Identifier: BSL-1.0
#include "nysalt/recommend.hpp"

#include <limits>

#include "comparison/recommendation.hpp"
#include "own_problem.hpp"

namespace nysalt {

class recommendation::contest_result {
 public:
  contest_result(const initial_value_problem& problem, const recommendation_options& options,
                 const execution_options& execution)
      : all(program::prepared(problem), options, program::settings_of(execution)) {
    all.learn_and_rank();
  }

  program::recommendation all;
};

bool recommendation::has_result() const { return found_->all.has_result(); }

std::string recommendation::verdict() const { return found_->all.asked().verdict(); }

std::string recommendation::method() const {
  const auto* best = found_->all.asked().best();
  return best == nullptr ? std::string() : best->source.typed;
}

double recommendation::step() const {
  const auto* best = found_->all.asked().best();
  return best == nullptr ? std::numeric_limits<double>::quiet_NaN() : best->step;
}

std::string recommendation::text() const {
  return program::with_arguments(found_->all.readable(), program::in_cpp);
}

std::string recommendation::json() const { return program::text_of(found_->all.document()); }

std::optional<std::string> recommendation::scheme() const { return found_->all.scheme(); }

std::vector<std::string> recommendation::warnings() const {
  return program::with_cpp_terms(found_->all.warnings());
}

recommendation recommend(const initial_value_problem& problem, const recommendation_options& options,
                         const execution_options& execution) {
  return program::with_cpp_messages([&] {
    return recommendation(
        std::make_shared<const recommendation::contest_result>(problem, options, execution));
  });
}

}  // namespace nysalt
