// SPDX-License-Identifier: BSL-1.0
#include "nysalt/recommend.hpp"

#include <limits>
#include <utility>

#include "comparison/recommendation.hpp"
#include "comparison/sampling_choice.hpp"
#include "own_problem.hpp"

namespace nysalt {

/// What is common to both purposes.
class recommendation::contest_result {
 public:
  virtual ~contest_result() = default;
  virtual bool has_result() const = 0;
  virtual std::string verdict() const = 0;
  virtual std::string readable() const = 0;
  virtual program::json document() const = 0;
  virtual std::optional<program::chosen_method> chosen() const = 0;
  virtual std::vector<std::string> warnings() const = 0;
};

namespace {

template <class Work>
class result_of : public recommendation::contest_result {
 public:
  template <class Options>
  result_of(const initial_value_problem& problem, const Options& options, const common_options& common)
      : all_(program::prepared(problem), options, program::settings_of(common)) {
    all_.learn_and_rank();
  }
  bool has_result() const override { return all_.has_result(); }
  std::string readable() const override { return all_.readable(); }
  program::json document() const override { return all_.document(); }
  std::optional<program::chosen_method> chosen() const override { return all_.chosen(); }
  std::vector<std::string> warnings() const override { return all_.warnings(); }

 protected:
  Work all_;
};

class best_for_runs : public result_of<program::recommendation> {
 public:
  using result_of::result_of;
  std::string verdict() const override { return all_.asked().verdict(); }
};

class best_for_sampling : public result_of<program::sampling_choice> {
 public:
  using result_of::result_of;
  std::string verdict() const override { return all_.verdict(); }
};

}  // namespace

bool recommendation::has_result() const { return found_->has_result(); }

std::string recommendation::verdict() const { return found_->verdict(); }

std::string recommendation::method() const {
  const auto best = found_->chosen();
  return best ? best->name : std::string();
}

double recommendation::step() const {
  const auto best = found_->chosen();
  return best ? best->step : std::numeric_limits<double>::quiet_NaN();
}

std::string recommendation::text() const { return found_->readable(); }

std::string recommendation::json() const { return program::text_of(found_->document()); }

std::optional<std::string> recommendation::method_file() const {
  auto best = found_->chosen();
  if (!best) return std::nullopt;
  return std::move(best->text);
}

std::vector<std::string> recommendation::warnings() const { return found_->warnings(); }

recommendation recommend(const initial_value_problem& problem, const recommendation_options& options,
                         const common_options& common) {
  return program::with_cpp_exceptions([&] {
    const program::told_caller told(common);
    return recommendation(std::make_shared<const best_for_runs>(problem, options, common));
  });
}

recommendation recommend_for_sampling(const initial_value_problem& problem, const sampling_options& options,
                                      const common_options& common) {
  return program::with_cpp_exceptions([&] {
    const program::told_caller told(common);
    return recommendation(std::make_shared<const best_for_sampling>(problem, options, common));
  });
}

}  // namespace nysalt
