// SPDX-License-Identifier: BSL-1.0
// The hosts, one file each.
#pragma once

#include <string>
#include <string_view>

#include "exported_method.hpp"

namespace nysalt::detail {

/// The name as an identifier: letters, digits and underscores, with a letter first.
std::string identifier_of(std::string_view name);

// Each throws std::invalid_argument where the host cannot take the word.
std::string export_to_c(const exported_method& method);
std::string export_to_cpp(const exported_method& method);
std::string export_to_fortran(const exported_method& method);
std::string export_to_python(const exported_method& method);
std::string export_to_julia(const exported_method& method);
std::string export_to_jax(const exported_method& method);
std::string export_to_odeint(const exported_method& method);
std::string export_to_sundials(const exported_method& method);
std::string export_to_ordinarydiffeq(const exported_method& method);
std::string export_to_ase(const exported_method& method);
std::string export_to_openmm(const exported_method& method);
std::string export_to_lammps(const exported_method& method);
std::string export_to_rebound(const exported_method& method);
std::string export_to_blackjax(const exported_method& method);
std::string export_to_mici(const exported_method& method);
std::string export_to_gpt(const exported_method& method);
std::string export_to_grid(const exported_method& method);
std::string export_to_chroma(const exported_method& method);
std::string export_to_tmlqcd(const exported_method& method);
std::string export_to_openqcd(const exported_method& method);

}  // namespace nysalt::detail
