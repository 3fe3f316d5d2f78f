// SPDX-License-Identifier: BSL-1.0

#include "nysalt/export_to.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <vector>

#include "bundled_templates.hpp"
#include "export_template.hpp"
#include "exported_method.hpp"
#include "nysalt/version.hpp"
#include "placeholders.hpp"

namespace nysalt {

namespace detail {

namespace {

/// The templates of share/exports by their place.
const std::vector<export_template>& all_hosts() {
  static const std::vector<export_template> all = [] {
    std::vector<export_template> result;
    for (const auto& [file, text] : bundled_templates()) result.push_back(head_of_template(text, file));
    std::ranges::sort(result, {}, &export_template::place);
    return result;
  }();
  return all;
}

std::string_view name_of(const export_template& host) { return host.file.substr(0, host.file.find('.')); }

bool is_taken(const export_template& host, std::string_view what) {
  return host.takes.find(what) != std::string_view::npos;
}

/// The hosts that take a letter, or words with a processor: c, cpp or python.
std::string hosts_that_take(std::string_view what) {
  std::vector<std::string_view> names;
  for (const auto& host : all_hosts())
    if (is_taken(host, what)) names.push_back(name_of(host));
  std::string result;
  for (std::size_t i = 0; i < names.size(); ++i)
    result += fmt::format("{}{}", i == 0 ? "" : i + 1 == names.size() ? " or " : ", ", names[i]);
  return result;
}

/// The text of a placeholder. Throws std::invalid_argument where the method has no such text.
std::string text_of(std::string_view name, const template_subject& of, std::size_t line);

bool holds(const template_condition& condition, const template_subject& of, std::size_t line) {
  return std::ranges::all_of(condition, [&](const template_term& term) {
    bool is_so = false;
    if (term.name == "has") {
      is_so = letters_written(kernel_of(of.method)).find(term.value) != std::string::npos;
    } else if (!term.value.empty()) {
      is_so = text_of(term.name, of, line) == term.value;
    } else {
      is_so = std::ranges::find(conditions(), term.name, &named_condition::name)->holds(of.method);
    }
    return is_so != term.is_negated;
  });
}

std::string text_of(std::string_view name, const template_subject& of, std::size_t line) {
  const placeholder& found = *std::ranges::find(placeholders(), name, &placeholder::name);
  if (!found.needs.empty() && found.needs != "loop" &&
      !holds(condition_in(found.needs, false, {}), of, line)) {
    refuse_export(
        "{}:{}: the method for @{}@ must be {}, got {} with the letters {}; put require {}: MESSAGE into the "
        "head",
        of.host.file, line, name, found.needs, of.method.method.name(),
        letters_written(composition_of(of.method)), found.needs);
  }
  return found.text(of);
}

/// The text of the pieces for a method.
std::string written(const template_text& pieces, const template_subject& of) {
  std::string result;
  for (const template_piece& piece : pieces) {
    switch (piece.is) {
      case template_piece::kind::text:
        result += piece.text;
        break;
      case template_piece::kind::placeholder:
        result += text_of(piece.text, of, piece.line);
        break;
      case template_piece::kind::choice:
        result += written(holds(piece.condition, of, piece.line) ? piece.first : piece.second, of);
        break;
      case template_piece::kind::loop:
        const exported_word word = std::ranges::find(words(), piece.text, &named_word::name)->word(of.method);
        for (std::size_t i = 0; i < word.size(); ++i) {
          if (i > 0) result += written(piece.second, of);
          result += written(piece.first, {of.method, of.host, &word[i], i});
        }
        break;
    }
  }
  return result;
}

void require_letters(const exported_method& method, const export_template& host) {
  if (has_bath(method) && !is_taken(host, "O")) {
    refuse_export(
        "export: the method for {} must be drifts and kicks, got {} with letters O, of a bath; take the "
        "method without a bath, or export to {}",
        host.title, method.method.name(), hosts_that_take("O"));
  }
  const std::string letters = letters_written(kernel_of(method));
  if (method.method.letters().is_processed() && !is_taken(host, "processor")) {
    refuse_export(
        "export: the method for {} must be a list of letters, got {} with a processor; export to {}, or take "
        "the method without the processor",
        host.title, method.method.name(), hosts_that_take("processor"));
  }
  if (letters.find('D') != std::string::npos && !is_taken(host, "D")) {
    refuse_export(
        "export: the method for {} must be drifts and kicks, got {} with a displaced kick; take a method of "
        "the letters A and B (nysalt list)",
        host.title, method.method.name());
  }
}

/// Requirements are checked in the order of the head.
void require_what_host_takes(const exported_method& method, const export_template& host) {
  for (std::size_t i = 0; i <= host.requirements.size(); ++i) {
    if (i == host.first_after_letters) require_letters(method, host);
    if (i == host.requirements.size()) return;
    const auto& [line, condition, refusal] = host.requirements[i];
    const template_subject of{method, host};
    if (!holds(condition, of, line)) throw std::invalid_argument("export: " + written(refusal, of));
  }
}

/// The name as an identifier: letters, digits and underscores, with a letter first.
std::string identifier_of(std::string_view name) {
  std::string result;
  for (const char c : name) {
    const bool stays = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (stays) result += c;
    if (!stays && !result.empty() && result.back() != '_') result += '_';
  }
  while (result.ends_with('_')) result.pop_back();
  if (result.empty() || std::isdigit(static_cast<unsigned char>(result.front())) != 0)
    result = "method_" + result;
  return result.substr(0, 40);  // Fortran takes 63, with what is added to it
}

std::string exported_text(const export_template& host, const method& method, const export_options& options) {
  const template_text pieces = text_of_template(host);
  const std::string& name = options.name.empty() ? method.name() : options.name;
  exported_method exported{method, identifier_of(name), options.about};
  if (options.displaced) exported = with_displaced_kicks(exported);
  require_what_host_takes(exported, host);
  const nysalt::word& word = exported.method.letters();
  auto& about = exported.about;
  about.insert(about.begin(),
               fmt::format("{}: letters {}, order {}{}.", exported.method.name(), word.letters(),
                           exported.method.order, has_bath(exported) ? " without noise" : ""));
  about.push_back(
      fmt::format("Force evaluations a step, the first and last joined: {}.", word.evaluations_per_step));
  about.push_back(fmt::format("Written by nysalt {}.", version));
  return written(pieces, {exported, host});
}

}  // namespace

}  // namespace detail

std::vector<export_host> export_hosts() {
  std::vector<export_host> result;
  for (const auto& host : detail::all_hosts())
    result.push_back({detail::name_of(host), host.what, host.suffix});
  return result;
}

std::string export_to(std::string_view host, const method& method, const export_options& options) {
  const auto& all = detail::all_hosts();
  const auto found = std::ranges::find(all, host, detail::name_of);
  if (found == all.end()) {
    std::string known;
    for (const auto& one : all) known += fmt::format("{}{}", known.empty() ? "" : ", ", detail::name_of(one));
    detail::refuse_export("export: the host must be one of {}, got '{}'", known, host);
  }
  return detail::exported_text(*found, method, options);
}

std::string export_by_template(std::string_view text, std::string_view file, const method& method,
                               const export_options& options) {
  return detail::exported_text(detail::head_of_template(text, file), method, options);
}

}  // namespace nysalt
