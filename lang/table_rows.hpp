// Rows of the tables of firmware/spec by the numbers that instructions hold, as far as a module has them.
#pragma once

#include <cstdint>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/global_parameters.hpp"
#include "firmware/spec/interrupts.hpp"
#include "firmware/spec/io_ports.hpp"
#include "firmware/spec/modules.hpp"

namespace opentmcl::lang {

// All of these give nullptr for what the module lacks.

const AxisParameterSpec* find_axis_parameter(std::int32_t number, const ModuleDescription& module);

/// A global parameter of bank 0.
const GlobalParameterSpec* find_module_setting(std::int32_t number, const ModuleDescription& module);

const InterruptSpec* find_interrupt(std::int32_t number, const ModuleDescription& module);

const IoPortSpec* find_port(std::int32_t port, std::int32_t bank, const ModuleDescription& module);

}  // namespace opentmcl::lang
