#pragma once

#include <cstdint>

#include "firmware/hal/pins.hpp"
#include "firmware/motion/axis.hpp"
#include "firmware/param/parameter_store.hpp"
#include "firmware/spec/lookup.hpp"
#include "firmware/spec/status_codes.hpp"

namespace opentmcl {

/// Reading, writing, storing and restoring axis parameters by number. SAP, AAP, GAP, STAP, RSAP and the start of the
/// module all come through here, so access and range are checked in one place.
class AxisParameterAccess {
 public:
  AxisParameterAccess(ModuleId module, Axis& axis, ParameterStore& store, hal::Pins& pins)
      : module_(module),
        columns_(axis_parameter_columns[static_cast<std::size_t>(module)]),
        axis_(axis),
        store_(store),
        pins_(pins) {}

  /// @return ok, or wrong_type when the module has no such parameter
  Status get(std::uint8_t number, std::int32_t& value);
  /// @return ok, wrong_type (no such parameter, or read only) or invalid_value (out of range)
  Status set(std::uint8_t number, std::int32_t value);
  /// @return ok, wrong_type when it cannot be stored, or eeprom_locked
  Status store(std::uint8_t number, bool is_locked);
  /// Sets the parameter to its stored value, or to its default when nothing is stored. @return ok or wrong_type
  Status restore(std::uint8_t number);

  /// Puts all stored values into the axis's settings without telling the chips: for the start, before
  /// Axis::initialise().
  void load_stored();

 private:
  std::uint8_t row_if(std::uint8_t number, Access access) const;
  void apply(AxisParameter parameter, std::size_t row, std::int32_t value);

  ModuleId module_;
  const ParameterColumns<axis_parameter_count>& columns_;
  Axis& axis_;
  ParameterStore& store_;
  hal::Pins& pins_;
};

}  // namespace opentmcl
