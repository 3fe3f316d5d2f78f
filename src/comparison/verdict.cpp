// SPDX-License-Identifier: BSL-1.0
#include "verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <span>

namespace nysalt::program {

estimate error_ratio(const ranked_method& a, const ranked_method& b) {
  if (!(a.error > 0.0) || !(b.error > 0.0)) return {};
  const double ratio = a.error / b.error;
  if (a.groups.empty() || a.groups.size() != b.groups.size()) {
    return {ratio, ratio * std::hypot(a.standard_error / a.error, b.standard_error / b.error)};
  }
  // d ln(a/b) = d a/a - d b/b
  std::vector<double> in_a;
  std::vector<double> in_b;
  for (const double x : a.groups) in_a.push_back(x / a.error);
  for (const double x : b.groups) in_b.push_back(x / b.error);
  return {ratio, ratio * paired_difference(in_a, in_b).standard_error};
}

bool errs_more(const ranked_method& a, const ranked_method& b) {
  if (!(a.error > b.error)) return false;
  constexpr double separated = 2.0;  // standard errors
  if (b.error == 0.0) return std::isnan(a.standard_error) || a.error > separated * a.standard_error;
  const estimate ratio = error_ratio(a, b);
  if (std::isnan(ratio.standard_error)) return true;
  return std::log(ratio.mean) > separated * ratio.standard_error / ratio.mean;
}

namespace {

bool has_error(const ranked_method& one) { return std::isfinite(one.error) && one.error >= 0.0; }

std::size_t methods_up_to(const std::vector<ranked_method>& all, double cost) {
  std::set<std::string> methods;
  for (const ranked_method& one : all) {
    if (one.cost <= cost) methods.insert(one.method);
  }
  return methods.size();
}

/// The ranked methods that cost no more, each method where it errs least; the least error first.
std::vector<ranked_method> affordable(const std::vector<ranked_method>& all, double cost) {
  std::map<std::string, ranked_method> by_method;
  for (const ranked_method& one : all) {
    if (one.cost > cost || !has_error(one)) continue;
    const auto [at, is_new] = by_method.emplace(one.method, one);
    if (!is_new && one.error < at->second.error) at->second = one;
  }
  std::vector<ranked_method> result;
  for (const auto& [method, one] : by_method) result.push_back(one);
  std::ranges::stable_sort(result, {}, &ranked_method::error);
  return result;
}

best_at_cost best_of(const std::vector<ranked_method>& sorted, double cost) {
  best_at_cost result{.cost = cost, .best = {}, .next = {}};
  if (sorted.empty()) return result;
  result.best.push_back(sorted.front());
  for (const ranked_method& one : std::span(sorted).subspan(1)) {
    if (!errs_more(one, sorted.front())) {
      result.best.push_back(one);
    } else if (!result.next) {
      result.next = one;
    }
  }
  if (sorted.size() > 1) {
    result.has_error_bars =
        std::ranges::none_of(sorted, [](const ranked_method& one) { return std::isnan(one.standard_error); });
  }
  return result;
}

/// The costs of all, those that are nearly the same as the largest of these.
std::vector<double> distinct_costs(const std::vector<ranked_method>& all, double tolerance) {
  std::vector<double> costs;
  for (const ranked_method& one : all) costs.push_back(one.cost);
  std::ranges::sort(costs);
  std::vector<double> result;
  double first = 0.0;
  for (const double cost : costs) {
    if (!result.empty() && cost <= tolerance * first) {
      result.back() = cost;
    } else {
      result.push_back(cost);
      first = cost;
    }
  }
  return result;
}

}  // namespace

std::vector<best_at_cost> best_at_costs(const std::vector<ranked_method>& all, double tolerance) {
  std::vector<ranked_method> sound;
  std::ranges::copy_if(all, std::back_inserter(sound),
                       [](const ranked_method& one) { return std::isfinite(one.cost) && one.cost > 0.0; });
  std::vector<best_at_cost> found;
  bool is_compared = false;
  for (const double cost : distinct_costs(sound, tolerance)) {
    const bool are_several = methods_up_to(sound, cost) > 1;
    if (are_several && !is_compared) found.clear();
    is_compared = is_compared || are_several;
    found.push_back(best_of(affordable(sound, cost), cost));
  }
  return found;
}

std::vector<double> without_start_up(const std::vector<double>& costs, double tolerance, double evaluation) {
  std::vector<double> result;
  for (const double own : costs) {
    double largest = own;
    for (const double other : costs) {
      if (other <= tolerance * own + evaluation) largest = std::max(largest, other);
    }
    result.push_back(largest);
  }
  return result;
}

std::string named(const std::vector<ranked_method>& methods) {
  constexpr std::size_t enough = 3;
  const std::size_t shown = methods.size() > enough ? enough - 1 : methods.size();
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) {
    const bool is_last = i > 0 && i + 1 == methods.size();
    text += fmt::format("{}`{}`", i == 0 ? "" : is_last ? " and " : ", ", methods[i].method);
  }
  if (shown < methods.size()) text += fmt::format(" and {} more", methods.size() - shown);
  return text;
}

std::string with_error(const estimate& value) {
  if (std::isnan(value.mean)) return "-";
  if (!(value.standard_error > 0.0)) return fmt::format("{:.4g}", value.mean);
  const int decimals = static_cast<int>(std::max(0.0, -std::floor(std::log10(value.standard_error))));
  return fmt::format("{0:.{2}f} ± {1:.{2}f}", value.mean, value.standard_error, decimals);
}

namespace {

/// Neighbouring costs with the same methods at the head.
struct range_of_costs {
  double from;
  double to;
  std::vector<ranked_method> best;
};

std::set<std::string> names_of(const std::vector<ranked_method>& methods) {
  std::set<std::string> names;
  for (const ranked_method& one : methods) names.insert(one.method);
  return names;
}

std::vector<range_of_costs> ranges_of(const std::vector<best_at_cost>& found) {
  std::vector<range_of_costs> result;
  for (const auto& [cost, best, next, has_error_bars] : found) {
    if (!result.empty() && names_of(result.back().best) == names_of(best)) {
      result.back().to = cost;
    } else {
      result.push_back({cost, cost, best});
    }
  }
  return result;
}

std::string words_of(const range_of_costs& range) {
  if (range.from == range.to) return fmt::format("at {:.4g}", range.from);
  return fmt::format("from {:.4g} to {:.4g}", range.from, range.to);
}

std::string leaders_of(const range_of_costs& range) {
  return named(range.best) + (range.best.size() > 1 ? " (which error bars do not separate)" : "");
}

/// "2,265", "11.7": of ratios from one on.
std::string grouped(double ratio) {
  if (ratio < 1000.0 || ratio >= 1e9) return fmt::format("{:.3g}", ratio);
  std::string text = fmt::format("{:.0f}", ratio);
  for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3)
    text.insert(static_cast<std::size_t>(at), ",");
  return text;
}

/// Of one method that leads at all costs: "`a` is best: at 100 to 200 evaluations its error is 2 to 9 times
/// smaller than that of the next, `b`". At costs below these no other method is ranked.
std::string lead_of(const std::vector<best_at_cost>& found, const std::string& unit,
                    const std::string& error) {
  const std::string leader = named(found.front().best);
  std::vector<double> costs;
  std::vector<estimate> ratios;
  std::set<std::string> seconds;
  for (const auto& one : found) {
    const estimate ratio =
        one.next ? error_ratio(*one.next, one.best.front()) : estimate{.mean = std::nan("")};
    if (std::isnan(ratio.mean)) continue;
    costs.push_back(one.cost);
    ratios.push_back(ratio);
    seconds.insert(one.next->method);
  }
  if (ratios.empty()) {
    return fmt::format("{} is best {} {}", leader, words_of({found.front().cost, found.back().cost, {}}),
                       unit);
  }
  const auto [least, largest] = std::ranges::minmax_element(ratios, {}, &estimate::mean);
  const std::string low = grouped(least->mean);
  const std::string high = grouped(largest->mean);
  std::string text = fmt::format("{} is best: at {:.4g}", leader, costs.front());
  if (costs.size() > 1) text += fmt::format(" to {:.4g}", costs.back());
  text += fmt::format(" {} its {} is {} times smaller than that of the next", unit, error,
                      low == high ? with_error(*least) : low + " to " + high);
  if (seconds.size() == 1) text += ", `" + *seconds.begin() + "`";
  if (!found.front().next)
    text += fmt::format("; at less, from {:.4g} on, no other is ranked", found.front().cost);
  return text;
}

}  // namespace

std::string verdict_of(const std::vector<best_at_cost>& at_all_costs, const std::string& unit,
                       const std::string& error) {
  // What can be afforded at a cost can be at a larger one: where none is ranked are the least costs.
  const auto first =
      std::ranges::find_if(at_all_costs, [](const best_at_cost& one) { return !one.best.empty(); });
  if (first == at_all_costs.end()) return "No method is ranked: there is nothing to say on who is best.";
  const std::vector<best_at_cost> found(first, at_all_costs.end());
  const auto ranges = ranges_of(found);
  std::set<std::string> ranked;
  for (const auto& one : found) {
    for (const ranked_method& method : one.best) ranked.insert(method.method);
    if (one.next) ranked.insert(one.next->method);
  }
  const bool is_only_row = ranked.size() == 1;
  const bool is_tie =
      std::ranges::all_of(found, [](const best_at_cost& one) { return !one.next && one.best.size() > 1; });
  std::string text;
  if (is_tie) {
    const range_of_costs whole{found.front().cost, found.back().cost, {}};
    text = fmt::format("No method is known to be better than another {} {}: error bars do not separate {}.",
                       words_of(whole), unit, named(found.back().best));
  } else if (is_only_row) {
    text = fmt::format("Only {} is ranked: there is no other to compare with.", named(found.back().best));
  } else if (constexpr std::size_t readable = 4; ranges.size() > readable) {
    text = fmt::format("Who is best depends on the cost, and changes {} times: {} {}, {} {} {}.",
                       ranges.size() - 1, leaders_of(ranges.front()), words_of(ranges.front()),
                       leaders_of(ranges.back()), words_of(ranges.back()), unit);
  } else if (ranges.size() > 1) {
    for (const auto& range : ranges) {
      text += fmt::format("{}{} {}", text.empty() ? "Who is best depends on the cost: " : ", ",
                          leaders_of(range), words_of(range));
    }
    text += fmt::format(" {}.", unit);
  } else if (ranges.front().best.size() == 1) {
    text = lead_of(found, unit, error) + ".";
  } else {
    text = fmt::format("The best are {} {} {}: error bars do not separate them.", named(ranges.front().best),
                       words_of(ranges.front()), unit);
  }
  if (first != at_all_costs.begin())
    text +=
        fmt::format(" None is ranked {}.", words_of({at_all_costs.front().cost, std::prev(first)->cost, {}}));
  const bool has_error_bars = std::ranges::all_of(found, &best_at_cost::has_error_bars);
  if (!has_error_bars && !is_only_row)
    text += " Some errors have no error bar, and differences may be chance.";
  return text;
}

namespace {

/// The methods at the head, from the least cost to the largest; neighbours of the same methods once.
std::vector<std::set<std::string>> sequence_of_leaders(const std::vector<best_at_cost>& found) {
  std::vector<std::set<std::string>> result;
  for (const auto& range : ranges_of(found)) result.push_back(names_of(range.best));
  return result;
}

}  // namespace

std::string verdict_of_both(const std::vector<best_at_cost>& by_evaluations,
                            std::vector<best_at_cost> by_seconds, const std::string& error) {
  std::string text = verdict_of(by_evaluations, evaluations_per_time, error);
  if (sequence_of_leaders(by_evaluations) == sequence_of_leaders(by_seconds)) return text;
  for (auto& one : by_seconds) one.cost *= 1e9;
  std::string of_seconds = verdict_of(by_seconds, "ns a unit of time", error);
  of_seconds.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(of_seconds.front())));
  return text + " In seconds: " + of_seconds;
}

}  // namespace nysalt::program
