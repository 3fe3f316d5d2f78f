// SPDX-License-Identifier: BSL-1.0
#include "method_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "catalogue.hpp"
#include "did_you_mean.hpp"
#include "document_reader.hpp"
#include "inputs.hpp"
#include "method_file_format.hpp"
#include "nysalt/derivatives/properties.hpp"
#include "nysalt/derivatives/taylor_order.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/letters.hpp"
#include "nysalt/losses/loss_choice.hpp"
#include "nysalt/method.hpp"
#include "refusal.hpp"
#include "stability.hpp"

namespace nysalt::program {

namespace {

/// Runs f; what the library refuses in it gets the file's name.
auto in_file(const std::string& file, const auto& f) {
  try {
    return f();
  } catch (const std::invalid_argument& problem) {
    refuse("cannot read {}: {}", file, problem.what());
  }
}

/// By name: the order of members means nothing in JSON. Each holds one number, or one for each step.
std::vector<Eigen::VectorXd> parameters_in(const json& parameters, const family& family, std::size_t steps,
                                           bool is_curve, const document_reader& read) {
  if (!parameters.is_object()) refuse("{}: \"parameters\" must be an object", read.file());
  std::vector<Eigen::VectorXd> thetas(steps, Eigen::VectorXd::Zero(family.parameters()));
  const document_reader values(parameters, read.file());
  for (Eigen::Index k = 0; k < family.parameters(); ++k) {
    const char* name = family.parameter_names[static_cast<std::size_t>(k)].c_str();
    if (!is_curve) {
      thetas[0][k] = values.number(name);
      continue;
    }
    const auto all = values.numbers(name);
    if (all.size() != steps) refuse("{}: \"{}\" must hold a number for each step", read.file(), name);
    for (std::size_t n = 0; n < steps; ++n) thetas[n][k] = all[n];
  }
  if (std::ssize(parameters) != family.parameters()) {
    refuse("{}: \"parameters\" must be those of the family {}, got others too: it has {}", read.file(),
           family.name, listed(family.parameter_names));
  }
  for (const auto& theta : thetas) detail::require_in_range(family, theta);
  return thetas;
}

placement placement_in(const document_reader& read) {
  const std::string name = read.text("placement");
  for (const auto known : placements) {
    if (name == to_string(known)) return known;
  }
  refuse("{}: unknown placement '{}': it is one of end, symmetric, middle", read.file(), name);
}

/// Nothing where the system has no energy, and where the loss asked for no data.
std::optional<energy_range> energies_in(const document_reader& read) {
  if (read.member("energy_range").is_null()) return {};
  const auto loss = detail::find_loss(read.text("objective"));
  if (loss && !loss->kind->asks_data()) return {};
  const auto ends = read.numbers("energy_range");
  if (ends.size() != 2 || !(ends[0] <= ends[1])) {
    refuse("{}: \"energy_range\" must hold the least and the largest energy", read.file());
  }
  return energy_range{ends[0], ends[1]};
}

/// One number, or one for each step where they differ.
std::size_t trajectories_in(const document_reader& read) {
  const auto all = read.member("trajectories").is_array() ? read.numbers("trajectories")
                                                          : std::vector<double>{read.number("trajectories")};
  const bool are_counts = std::ranges::all_of(all, [](double n) { return n >= 1.0 && n <= 1e15; });
  if (all.empty() || !are_counts) refuse("{}: \"trajectories\" must be positive", read.file());
  return static_cast<std::size_t>(std::ranges::min(all));
}

/// A member that holds a whole number from 0 to a largest one.
int whole_in(const document_reader& read, const char* name, int most) {
  const double value = read.number(name);
  if (!(value >= 0.0 && value <= most) || value != std::floor(value)) {
    refuse("{}: \"{}\" must be a whole number from 0 to {}, got {}; learn the scheme again", read.file(),
           name, most, value);
  }
  return static_cast<int>(value);
}

/// The name of a letter of one's own: not one that the library has, and each once.
char letter_in(const document_reader& read, const std::vector<letter_facts>& before) {
  const std::string name = read.text("letter");
  const bool is_free =
      name.size() == 1 && std::isalnum(static_cast<unsigned char>(name[0])) != 0 &&
      std::ranges::find(detail::letter_table, name[0], &letter_facts::letter) == detail::letter_table.end() &&
      std::ranges::find(before, name[0], &letter_facts::letter) == before.end();
  if (!is_free) {
    refuse(
        "{}: each \"letter\" of \"own_letters\" must be another letter or digit, and none of the library, "
        "got {}; learn the scheme again",
        read.file(), json(name).dump(-1, ' ', true, json::error_handler_t::replace));
  }
  return name[0];
}

/// Of which parts its coefficients are the times, a character for each.
std::string times_in(const document_reader& read) {
  constexpr std::size_t most = detail::short_text::most;
  std::string times = read.text("times");
  const bool are_names = std::ranges::all_of(times, [](unsigned char c) { return std::isgraph(c) != 0; });
  if (times.empty() || times.size() > most || !are_names) {
    refuse(
        "{}: \"times\" must have a character for each coefficient of the letter, 1 to {}, got {}; learn the "
        "scheme again",
        read.file(), most, times.size());
  }
  return times;
}

/// The letters of its system that a scheme states.
std::vector<letter_facts> own_letters_in(const json& document, const document_reader& read) {
  std::vector<letter_facts> result;
  if (!document.contains("own_letters")) return result;
  const json& all = read.member("own_letters");
  if (!all.is_array()) {
    refuse("{}: \"own_letters\" must be a list of objects, got {}; learn the scheme again", read.file(),
           all.type_name());
  }
  for (const auto& stated : all) {
    if (!stated.is_object()) {
      refuse("{}: \"own_letters\" must be a list of objects, got one with a {}; learn the scheme again",
             read.file(), stated.type_name());
    }
    const document_reader one(stated, read.file());
    const char name = letter_in(one, result);
    const std::string times = times_in(one);
    constexpr int most_forces = 64;
    result.push_back(as_stated({.letter = name,
                                .slots = times.size(),
                                .displaced_forces = whole_in(one, "forces", most_forces),
                                .moves_q = one.flag("moves_q"),
                                .additive = one.flag("additive"),
                                .symplectic = one.flag("symplectic"),
                                .times = std::string_view(times)}));
  }
  return result;
}

scheme scheme_in(const json& document, const document_reader& read) {
  if (read.text("checksum") != checksum(document)) {
    refuse(
        "{}: \"checksum\" must fit the contents of the file, which was edited or damaged; learn the scheme "
        "again, or write coefficients of your own as a table",
        read.file());
  }
  const std::string name = read.text("family");
  const document_reader of_system(read.member("system"), read.file());
  const auto own_letters = own_letters_in(document, read);
  const nysalt::family family = [&] {
    try {
      return family_named(name, own_letters);
    } catch (const refusal& problem) {
      refuse("cannot read {}: {}", read.file(), problem.what());
    }
  }();
  const bool is_curve = document.contains("steps");
  const auto steps = is_curve ? read.numbers("steps") : std::vector<double>{read.number("step")};
  for (std::size_t n = 0; n < steps.size(); ++n) {
    if (!(steps[n] > 0.0)) refuse("{}: \"step\" must be positive, got {}", read.file(), steps[n]);
    if (n > 0 && !(steps[n - 1] < steps[n])) refuse("{}: \"steps\" must rise", read.file());
  }
  if (is_curve && document.contains("step")) {
    refuse("{} must have one of \"step\" and \"steps\", got both; learn the scheme again", read.file());
  }
  if (steps.empty()) refuse("{}: \"steps\" must be one or more, got none", read.file());
  const auto trajectories = trajectories_in(read);
  const auto energies = energies_in(read);
  return in_file(read.file(), [&] {
    const auto thetas = parameters_in(read.member("parameters"), family, steps.size(), is_curve, read);
    std::optional<placement> where;
    if (document.contains("placement")) where = placement_in(read);
    scheme result{name,
                  where,
                  theta_curve(steps, thetas),
                  of_system.text("description"),
                  document.at("system").contains("kind") ? of_system.text("kind") : "",
                  source_of_system(document.at("system")),
                  read.flag("usable"),
                  read.text("reason"),
                  energies,
                  trajectories,
                  own_letters};
    result.at(steps.front());  // throws if the word cannot take the placement
    return result;
  });
}

/// "A adds up to 1, B adds up to 0.9": drifts or rotations, and kicks of any kind; a method needs both.
std::string sums_of(const nysalt::word& word, const std::vector<double>& coefficients) {
  std::map<std::string, double> sums{{word.rotates() ? "R" : "A", 0.0}, {word.rotates() ? "S" : "B", 0.0}};
  for (std::size_t i = 0; i < word.length; ++i) {
    std::string letter(1, word.letters()[i]);
    if (letter[0] == detail::bath_letter) continue;
    if (letter == "G" || letter == "D") letter = "B";  // their first coefficient is that of a kick
    if (letter == "H") letter = "S";
    sums[letter] += coefficients[word.first_slot(i)];
  }
  const std::string_view processor = word.processor();
  for (std::size_t i = 0; i < processor.size(); ++i) {
    sums[fmt::format("{} of the processor", processor[i])] += coefficients[word.kernel_slots + i];
  }
  std::vector<std::string> texts;
  for (const auto& [letter, sum] : sums) texts.push_back(fmt::format("{} adds up to {:.10g}", letter, sum));
  return listed(texts);
}

/// The order of a word with letters of a system. Where these are of two parts of H, they obey the conditions
/// of drifts and kicks; where there are more, it is that of its symmetry.
int order_of(const method& method, std::string times) {
  const std::string letters = method.letters().letters();
  const auto other = times.find_first_not_of(times[0]);
  const bool are_two = other != std::string::npos && times.size() == letters.size() &&
                       std::ranges::all_of(times, [second = times[other], first = times[0]](char part) {
                         return part == first || part == second;
                       });
  if (!are_two) return method.symmetric ? 2 : 1;
  std::ranges::transform(times, times.begin(),
                         [first = times[0]](char part) { return part == first ? 'A' : 'B'; });
  return taylor_order(nysalt::word(times), method.coefficients()).any_kinetic;
}

/// A table with letters of the system.
method table_of_system(const std::string& name, const nysalt::word& word,
                       const std::vector<double>& coefficients, const document_reader& read,
                       std::optional<double> declared) {
  const method bare(name, word, coefficients, {1, is_palindrome(word, coefficients), word.rotates()});
  const std::string times = times_of_slots(word);
  std::map<char, double> sums;
  for (std::size_t k = 0; k < times.size(); ++k) sums[times[k]] += coefficients[k];
  for (const auto& [part, sum] : sums) {
    constexpr double rounding = 1e-10;  // of decimals as they are printed
    if (std::abs(sum - 1.0) <= rounding) continue;
    refuse("{}: the coefficients of {} must add up to 1, to ten digits, got {}", read.file(), part, sum);
  }
  const int order = order_of(bare, times);
  if (declared && *declared > order) {
    refuse(
        "{}: \"order\" must be at most {}, which the word {} is known to have, got {}; leave \"order\" away",
        read.file(), order, word.letters(), *declared);
  }
  return {name, word, coefficients, {order, bare.symmetric, bare.requires_quadratic_kinetic}};
}

method table_in(const json& document, const document_reader& read,
                const std::vector<letter_facts>& of_system) {
  if (document.contains("placement")) {
    refuse("{}: a table must have no \"placement\"; write O among its letters, or FILE@PLACEMENT",
           read.file());
  }
  const std::string letters = read.text("letters");
  constexpr std::size_t most_letters = 200;  // letters: measurement the order takes their square, a second
  if (letters.size() > most_letters) {
    refuse("{}: a table must have at most {} letters, got {}", read.file(), most_letters, letters.size());
  }
  const std::vector<double> coefficients = read.numbers("coefficients");
  return in_file(read.file(), [&] {
    const nysalt::word word(letters, of_system);
    const std::string name = document.contains("name") ? read.text("name") : "table";
    if (word.has_own_letters()) {
      if (word.is_processed() || word.stochastic_letters > 0) {
        refuse("{}: a table with letters of a system must have no processor and no letters O, got {}",
               read.file(), letters);
      }
      const auto declared = document.contains("order") ? std::optional(read.number("order")) : std::nullopt;
      return table_of_system(name, word, coefficients, read, declared);
    }
    const method bare(name, word, coefficients, {1, false, false});
    if (word.stochastic_letters > 0)
      detail::intervals_of_noise(word, coefficients);  // letters O cover the step once
    const auto found = taylor_order(bare);
    if (found.quadratic_kinetic < 1) {
      refuse(
          "{}: it is not consistent: {}; each must add up to {}, to ten digits, from moderate coefficients",
          read.file(), sums_of(word, coefficients),
          word.is_processed() ? "1, and of the processor to 0" : "1");
    }
    if (document.contains("order")) {
      const double declared = read.number("order");
      if (!(declared >= 1.0) || declared != std::floor(declared)) {
        refuse("{}: \"order\" must be 1, 2, ..., got {}", read.file(), declared);
      }
      if (declared > found.quadratic_kinetic) {
        refuse(
            "{}: \"order\" must be at most {}, to which steps agree with the flow, got {}; correct a "
            "mistyped coefficient, or leave \"order\" away",
            read.file(), found.quadratic_kinetic, declared);
      }
    }
    if (!word.reads_modes && limit_of(bare) == 0.0) {  // throws where there are too many letters
      refuse("{} must be linearly stable at small steps; take other coefficients", read.file());
    }
    return method(name, word, coefficients,
                  {found.quadratic_kinetic, is_palindrome(word, coefficients),
                   found.any_kinetic < found.quadratic_kinetic || word.reads_modes});
  });
}

}  // namespace

letter_facts as_stated(const letter_facts& of_system) {
  return {.letter = of_system.letter,
          .slots = of_system.slots,
          .displaced_forces = of_system.displaced_forces,
          .moves_q = of_system.moves_q,
          .additive = of_system.additive,
          .symplectic = of_system.symplectic,
          .times = of_system.times};
}

method scheme::at(double step) const {
  const double inside = std::clamp(step, curve.steps().front(), curve.steps().back());
  const nysalt::family placed_family = placed(family, where, own_letters);
  Eigen::VectorXd theta = curve.at(inside);
  for (Eigen::Index k = 0; k < theta.size(); ++k) {  // a curve may swing beyond a bound that is attained
    const auto& [low, high, open] = placed_family.ranges[static_cast<std::size_t>(k)];
    if (!open) theta[k] = std::clamp(theta[k], low, high);
  }
  detail::require_in_range(placed_family, theta);
  return method(placed_family.name, placed_family.letters, placed_family.coefficients(theta),
                {placed_family.order, placed_family.symmetric, placed_family.requires_quadratic_kinetic});
}

nysalt::word scheme::letters() const { return placed(family, where, own_letters).letters; }

std::string scheme::steps() const {
  const auto& all = curve.steps();
  return all.size() == 1 ? message("the step {}", all.front())
                         : message("steps from {} to {}", all.front(), all.back());
}

std::string source_of_system(const json& parameters) {
  if (!parameters.contains("source")) return {};
  json known = parameters;
  for (const char* other : {"description", "kind", "spread", "friction", "sigma"}) known.erase(other);
  return known.dump();
}

method_file read_method_file(const std::filesystem::path& path, const std::vector<letter_facts>& of_system) {
  return method_file_in(contents_of(path, longest_method_file, "a scheme or a table"), path.string(),
                        of_system);
}

method_file method_file_in(const std::string& text, const std::string& file,
                           const std::vector<letter_facts>& of_system) {
  json document;
  if (text.size() > longest_method_file) {
    refuse("{} must be a scheme or a table, at most {} bytes long", file, longest_method_file);
  }
  if (!may_be_parsed(text)) {
    refuse("{} must be a scheme or a table, nested at most {} deep, with few members", file,
           deepest_document);
  }
  try {
    std::vector<std::set<std::string>> names;  // of the objects that are open
    document = json::parse(text, [&](int, json::parse_event_t event, json& value) {
      if (event == json::parse_event_t::object_start) names.emplace_back();
      if (event == json::parse_event_t::object_end) names.pop_back();
      if (event == json::parse_event_t::key && !names.back().insert(value.get<std::string>()).second) {
        refuse("{}: members must have different names, got \"{}\" twice", file, value.get<std::string>());
      }
      return true;
    });
  } catch (const json::parse_error& problem) {
    refuse("{} must be whole JSON, got an end or a break at byte {}; write the file anew if it was cut off",
           file, problem.byte);
  } catch (const json::out_of_range&) {
    refuse("{}: numbers must be finite, got one that is too large", file);
  }
  const bool is_ours = document.is_object() && document.contains("format") && document["format"].is_string();
  const std::string format = is_ours ? document["format"].get<std::string>() : "";
  if (format != scheme_format && format != table_format) {
    refuse("{}: this is neither a scheme nor a table: its \"format\" must be \"{}\" or \"{}\"", file,
           scheme_format, table_format);
  }
  const document_reader read(document, file);
  const double file_version = read.number("version");
  const bool is_scheme = format == scheme_format;
  const bool is_placed = is_scheme && document.contains("placement");
  const bool is_curve = is_scheme && document.contains("steps");
  const int newest = is_scheme ? as_curve : known_version;
  if (file_version > newest) {
    refuse(
        "{}: \"version\" must be at most {} for this nysalt, got {}; take a newer nysalt, or learn the "
        "scheme again",
        file, newest, file_version);
  }
  const int version = is_curve ? as_curve : is_placed ? with_placement : known_version;
  if (file_version != version) {
    refuse("{}: \"version\" must be {} {} a placement and {} several steps, got {}", file, version,
           is_placed ? "with" : "without", is_curve ? "with" : "without", file_version);
  }
  method_file result;
  if (format == scheme_format) {
    result.learned = scheme_in(document, read);
  } else {
    result.table = table_in(document, read, of_system);
  }
  return result;
}

}  // namespace nysalt::program
