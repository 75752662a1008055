// Words for the enumerations of firmware/spec, as `tmcl spec` prints them.
#pragma once

#include <string>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/global_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "firmware/spec/interrupts.hpp"
#include "firmware/spec/io_ports.hpp"
#include "firmware/spec/modules.hpp"
#include "firmware/spec/parameter_rows.hpp"
#include "firmware/spec/status_codes.hpp"

namespace opentmcl::app {

/// The letters of the manuals: "RWE".
std::string letters_of(Access access);

const char* name_of(Field field);
const char* name_of(Where where);
const char* name_of(InterruptSetting setting);
// Found beside the others although it lives in opentmcl.
using opentmcl::name_of;

}  // namespace opentmcl::app
