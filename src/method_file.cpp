// SPDX-License-Identifier: BSL-1.0
#include "method_file.hpp"

#include <algorithm>
#include <boost/crc.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <utility>

#include "build_info.hpp"
#include "catalogue.hpp"
#include "learning.hpp"
#include "nysalt/derivatives/taylor_order.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/methods/thermostatted.hpp"
#include "refusal.hpp"
#include "stability.hpp"

namespace nysalt::program {

namespace {

constexpr int known_version = 1;
constexpr int with_placement = 2;  // of a scheme that says where its letters O are
constexpr const char* scheme_format = "nysalt scheme";
constexpr const char* table_format = "nysalt table";

/// Of everything but itself, as it would be written without spaces.
std::string checksum(json document) {
  document.erase("checksum");
  const std::string text = document.dump();
  boost::crc_32_type crc;
  crc.process_bytes(text.data(), text.size());
  return fmt::format("crc32:{:08x}", crc.checksum());
}

std::string contents_of(const std::filesystem::path& path) {
  constexpr std::streamsize most = 1 << 20;  // bytes: schemes and tables are far shorter
  std::error_code ignored;
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path, ignored)) {
    refuse("cannot read {}: is it there, a file, and readable?", path.string());
  }
  std::string text(static_cast<std::size_t>(most), '\0');
  stream.read(text.data(), most);
  if (stream) refuse("{}: it is too long to be a scheme or a table", path.string());
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

/// Members of a JSON object, each of its type, or a refusal that names file and member.
class reader {
 public:
  reader(const json& document, std::string file) : document_(document), file_(std::move(file)) {}

  const json& member(const char* key) const {
    if (!document_.contains(key)) refuse("{}: the member \"{}\" is missing", file_, key);
    return document_[key];
  }
  std::string text(const char* key) const {
    if (!member(key).is_string()) refuse("{}: \"{}\" must be a text", file_, key);
    return member(key).get<std::string>();
  }
  double number(const char* key) const { return number(member(key), key); }
  double number(const json& value, const char* key) const {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      refuse("{}: \"{}\" must hold finite numbers", file_, key);
    }
    return value.get<double>();
  }
  bool flag(const char* key) const {
    if (!member(key).is_boolean()) refuse("{}: \"{}\" must be true or false", file_, key);
    return member(key).get<bool>();
  }
  const std::string& file() const { return file_; }

 private:
  const json& document_;
  std::string file_;
};

/// Runs f; what the library refuses in it gets the file's name.
auto in_file(const std::string& file, const auto& f) {
  try {
    return f();
  } catch (const std::invalid_argument& problem) {
    refuse("{}: {}", file, problem.what());
  }
}

/// By name: the order of members means nothing in JSON.
std::vector<double> parameters_in(const json& parameters, const std::string& family, const reader& read) {
  std::vector<double> theta;
  const reader values(parameters, read.file());
  const auto known = family_names();
  if (std::find(known.begin(), known.end(), family) == known.end()) {
    refuse("{}: unknown family '{}': it is one of {}", read.file(), family, listed(known));
  }
  with_family(family, [&]<class F>(F) {
    for (const auto name : F::parameter_names) theta.push_back(values.number(std::string(name).c_str()));
    if (parameters.size() == theta.size()) return;
    refuse("{}: the family {} has the parameters {} and no others", read.file(), family,
           listed(F::parameter_names));
  });
  return theta;
}

placement placement_in(const reader& read) {
  const std::string name = read.text("placement");
  for (const auto known : placements) {
    if (name == to_string(known)) return known;
  }
  refuse("{}: unknown placement '{}': it is one of end, symmetric, middle", read.file(), name);
}

scheme scheme_in(const json& document, const reader& read) {
  if (read.text("checksum") != checksum(document)) {
    refuse(
        "{}: its checksum does not fit its contents, so it was edited or damaged; learn it again, or write "
        "coefficients of your own as a table",
        read.file());
  }
  const std::string family = read.text("family");
  const std::vector<double> theta = parameters_in(read.member("parameters"), family, read);
  const double step = read.number("step");
  if (!(step > 0.0)) refuse("{}: \"step\" must be positive, it is {}", read.file(), step);
  const reader of_system(read.member("system"), read.file());
  return in_file(read.file(), [&] {
    tabulated method = family_member(family, theta);
    if (document.contains("placement")) method = thermostat(method, placement_in(read));
    return scheme{method, step, of_system.text("description"), read.flag("usable"), read.text("reason")};
  });
}

/// "A adds up to 1, B adds up to 0.9"
std::string sums_of(const std::string& letters, const std::vector<double>& coefficients) {
  std::map<char, double> sums{{'A', 0.0}, {'B', 0.0}};  // a method needs both
  for (std::size_t i = 0; i < letters.size(); ++i) {
    if (letters[i] != ornstein_uhlenbeck::letter) sums[letters[i]] += coefficients[i];
  }
  std::vector<std::string> texts;
  for (const auto& [letter, sum] : sums) texts.push_back(fmt::format("{} adds up to {}", letter, sum));
  return listed(texts);
}

tabulated table_in(const json& document, const reader& read) {
  if (document.contains("placement")) {
    refuse("{}: a table has no \"placement\": write O among its letters, or FILE@PLACEMENT", read.file());
  }
  const std::string letters = read.text("letters");
  constexpr std::size_t most_letters = 200;  // finding the order takes their square: a second
  if (letters.size() > most_letters) {
    refuse("{}: a table has at most {} letters, this one has {}", read.file(), most_letters, letters.size());
  }
  const json& list = read.member("coefficients");
  if (!list.is_array()) refuse("{}: \"coefficients\" must be a list of numbers", read.file());
  std::vector<double> coefficients;
  for (const auto& value : list) coefficients.push_back(read.number(value, "coefficients"));
  return in_file(read.file(), [&] {
    const run_time_word word(letters);
    const std::string name = document.contains("name") ? read.text("name") : "table";
    const tabulated bare(name, word, coefficients, {1, false, false});
    if (word.stochastic_letters > 0) intervals_of_noise(word, coefficients);  // they cover the step once
    const auto found = taylor_order(bare);
    if (found.quadratic_kinetic < 1) {
      refuse("{}: it is not consistent: {}; each must add up to 1, to ten digits, from moderate coefficients",
             read.file(), sums_of(letters, coefficients));
    }
    if (document.contains("order")) {
      const double declared = read.number("order");
      if (!(declared >= 1.0) || declared != std::floor(declared)) {
        refuse("{}: \"order\" must be 1, 2, ..., not {}", read.file(), declared);
      }
      if (declared > found.quadratic_kinetic) {
        refuse(
            "{}: it declares the order {}, but its steps agree with the flow to order {} only; is a "
            "coefficient mistyped?",
            read.file(), declared, found.quadratic_kinetic);
      }
    }
    if (limit_of(bare) == 0.0) {  // throws where there are too many letters to tell
      refuse("{}: it is not linearly stable at any small step", read.file());
    }
    const auto palindrome = [](const auto& x) { return std::equal(x.begin(), x.end(), x.rbegin()); };
    return tabulated(name, word, coefficients,
                     {found.quadratic_kinetic, palindrome(letters) && palindrome(coefficients),
                      found.any_kinetic < found.quadratic_kinetic});
  });
}

}  // namespace

std::string scheme_text(const learned_scheme& learned, const bundled_system& system, const learn_plan& plan) {
  const fit_summary& fit = learned.fit;
  json of_system = system.parameters();
  of_system["description"] = system.description();
  json document{{"format", scheme_format},
                {"version", plan.where ? with_placement : known_version},
                {"family", fit.family},
                {"parameters", by_name(fit, &fitted_parameter::value)},
                {"standard_errors", by_name(fit, &fitted_parameter::standard_error)},
                {"step", fit.step},
                {"system", of_system},
                {"energy_range", nullptr},
                {"loss", fit.loss},
                {"held_out_loss", fit.held_out_loss},
                {"usable", fit.usable},
                {"reason", fit.reason},
                {"coordinates", fit.coordinates},
                {"reference", fit.reference},
                {"starts", fit.ensemble},
                {"trajectories", fit.trajectories},
                {"horizon", plan.how.horizon},
                {"seed", fit.seed},
                {"held_out_seed", fit.held_out_seed},
                {"versions", {{"nysalt", version}}}};
  if (learned.energies) document["energy_range"] = {learned.energies->low, learned.energies->high};
  if (plan.where) document["placement"] = to_string(*plan.where);
  document["checksum"] = checksum(document);
  return text_of(document);
}

method_file read_method_file(const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::string text = contents_of(path);
  json document;
  try {
    constexpr int deepest = 8;
    document = json::parse(text, [&](int depth, json::parse_event_t, json&) {
      if (depth > deepest) refuse("{}: it is nested too deeply to be a scheme or a table", file);
      return true;
    });
  } catch (const json::parse_error& problem) {
    refuse("{}: this is not whole JSON (it ends or breaks at byte {}); was it cut off?", file, problem.byte);
  } catch (const json::out_of_range&) {
    refuse("{}: it holds a number that is not finite", file);
  }
  const bool is_ours = document.is_object() && document.contains("format") && document["format"].is_string();
  const std::string format = is_ours ? document["format"].get<std::string>() : "";
  if (format != scheme_format && format != table_format) {
    refuse("{}: this is neither a scheme nor a table: its \"format\" must be \"{}\" or \"{}\"", file,
           scheme_format, table_format);
  }
  const reader read(document, file);
  const double file_version = read.number("version");
  const bool is_placed = format == scheme_format && document.contains("placement");
  const int newest = format == scheme_format ? with_placement : known_version;
  if (file_version > newest) {
    refuse("{}: it has version {}, and this nysalt knows {} at most: take a newer nysalt, or learn it again",
           file, file_version, newest);
  }
  if (file_version != (is_placed ? with_placement : known_version)) {
    refuse("{}: there is no version {} {} a placement", file, file_version, is_placed ? "with" : "without");
  }
  method_file result;
  if (format == scheme_format) {
    result.learned = scheme_in(document, read);
  } else {
    result.table = table_in(document, read);
  }
  return result;
}

}  // namespace nysalt::program
