// SPDX-License-Identifier: BSL-1.0
#include "svg.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include "escaped.hpp"

namespace nysalt {

namespace {

/// "verlet: step 0.1, error 3.2e-04 ± 1e-05", of point i of curve j, which are counted over all panels.
std::string value_of(const figure& f, std::size_t j, std::size_t i) {
  for (const auto& panel : f.panels) {
    if (j >= panel.curves.size()) {
      j -= panel.curves.size();
      continue;
    }
    const curve& one = panel.curves[j];
    if (i >= one.x.size() || i >= one.y.size()) break;
    const auto named = [](const std::string& name) { return name.empty() ? name : name + " "; };
    std::string text = fmt::format("{}: {}{:.4g}, {}{:.4g}", one.label, named(panel.x_label), one.x[i],
                                   named(panel.y_label), one.y[i]);
    const bool has_error = i < one.error.size() && std::isfinite(one.error[i]) && one.error[i] > 0.0;
    return has_error ? text + fmt::format(" ± {:.1g}", one.error[i]) : text;
  }
  return {};
}

/// With own ids, and the values of a point.
std::string finished_tag(const std::string& tag, const figure& f) {
  static const std::regex id(R"re(( id=['"]|href=['"]#|url\(['"]?#))re");
  static const std::regex plot(R"re( id="gnuplot_plot_[^"]*")re");  // which panels repeat
  static const std::regex point(R"re(showHypertext\(evt,'(\d+)\.(\d+)'\))re");
  if (std::smatch found; std::regex_search(tag, found, point)) {
    const auto number = [&](std::size_t k) { return std::strtoul(found[k].str().c_str(), nullptr, 10); };
    return fmt::format("<g class=\"point\"><title>{}</title>",
                       html_escaped(value_of(f, number(1), number(2))));
  }
  return std::regex_replace(std::regex_replace(tag, plot, ""), id, "$1" + f.name + "-");
}

}  // namespace

std::string finished_svg(const std::string& drawn, const figure& f) {
  static const std::regex title(R"(<(title|desc)>[^<]*</\1>\s*)");
  static const std::regex nothing(R"(<g [^>]*>\s*</g>\s*)");
  static const std::regex tag("<[^>]*>");
  const std::string text = std::regex_replace(std::regex_replace(drawn, title, ""), nothing, "");
  std::string result;
  std::string::const_iterator from = text.begin();
  for (std::sregex_iterator at(text.begin(), text.end(), tag), end; at != end; ++at) {
    result.append(from, (*at)[0].first);
    result += finished_tag((*at)[0].str(), f);
    from = (*at)[0].second;
  }
  return result.append(from, text.cend());
}

std::string svg_element(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::size_t from = text.find("<svg");
  const std::string last = "</svg>";
  const std::size_t end = text.rfind(last);
  const bool is_whole = from != std::string::npos && end != std::string::npos && from < end;
  return is_whole ? text.substr(from, end + last.size() - from) : "";
}

}  // namespace nysalt
