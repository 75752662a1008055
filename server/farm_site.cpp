#include "server/farm_site.hpp"

#include <utility>

#include "firmware/spec/lookup.hpp"
#include "server/module_setup.hpp"

namespace opentmcl::server {

using client::Error;
using client::Result;

struct FarmSite::Line {
  explicit Line(std::uint32_t baud_rate) : line(*port, baud_rate) {}

  std::shared_ptr<RequestPort> port = std::make_shared<RequestPort>();
  Rs485Line line;
  std::optional<OpenDoors> doors;
};

struct FarmSite::Bus {
  std::shared_ptr<SharedCanBus> bus = std::make_shared<SharedCanBus>();
  std::optional<OpenDoors> doors;
  std::vector<std::size_t> members;
};

struct FarmSite::Module {
  std::size_t member = 0;
  std::optional<OpenDoors> doors;
  std::shared_ptr<SharedCanPort> own_can;
  SharedCanPort* can = nullptr;  ///< own_can, or a connector of a bus
  MemoryLine setup_line;
  std::vector<std::unique_ptr<PacedPort>> wires;
  std::unique_ptr<KeptEeprom> eeprom;
  std::unique_ptr<VirtualModule> module;
};

namespace {

/// Of a module fresh from the factory; its identifier on CAN is the same.
constexpr auto default_address = static_cast<unsigned>(
    global_parameter_columns[static_cast<std::size_t>(pd1161.id)][row_of(GlobalParameter::serial_address)]
        .default_value);

Error named(const std::string& name, Error error) {
  error.message = name + ": " + error.message;
  return error;
}

}  // namespace

FarmSite::FarmSite(boost::asio::io_context& events, FarmDescription description, Programs programs, WallClock clock)
    : events_(events), description_(std::move(description)), programs_(std::move(programs)), clock_(std::move(clock)) {}

FarmSite::~FarmSite() = default;

Result<std::unique_ptr<FarmSite>> FarmSite::build(boost::asio::io_context& events, FarmDescription description,
                                                  Programs programs, Farm::Options options, WallClock clock) {
  std::unique_ptr<FarmSite> site(new FarmSite(events, std::move(description), std::move(programs), std::move(clock)));
  if (Result<void> built = site->build_buses(); !built) return built.error();
  const std::size_t count = site->description_.modules.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (Result<void> built = site->build_module(i); !built)
      return named(site->description_.modules[i].name, built.error());
  }
  // Only now that all ends of all lines are there may time pass.
  for (std::size_t i = 0; i < count; ++i) {
    if (Result<void> done = site->set_up_module(i); !done)
      return named(site->description_.modules[i].name, done.error());
  }
  site->build_farm(options);
  return site;
}

Result<void> FarmSite::build_buses() {
  for (const FarmRs485Line& wanted : description_.rs485_lines) {
    const std::size_t member = member_modules_.size();
    member_modules_.emplace_back();
    Line& line = *lines_.emplace_back(std::make_unique<Line>(wanted.baud_rate));
    Result<OpenDoors> doors =
        OpenDoors::open(events_, wanted.doors, description_.tcp_address, line.port, nullptr, serving(member), clock_);
    if (!doors) return named(wanted.name, doors.error());
    line.doors.emplace(std::move(*doors));
  }
  for (const FarmCanBus& wanted : description_.can_buses) {
    Bus& bus = *buses_.emplace_back(std::make_unique<Bus>());
    const auto serve_all = [this, &bus](WallTime now) {
      for (const std::size_t member : bus.members) farm_->serve(member, now);
    };
    Result<OpenDoors> doors =
        OpenDoors::open(events_, wanted.doors, description_.tcp_address, nullptr, bus.bus, serve_all, clock_);
    if (!doors) return named(wanted.name, doors.error());
    bus.doors.emplace(std::move(*doors));
  }
  return {};
}

RequestsArrived FarmSite::serving(std::size_t member) {
  return [this, member](WallTime now) { farm_->serve(member, now); };
}

Result<void> FarmSite::build_module(std::size_t index) {
  const FarmModule& wanted = description_.modules[index];
  Module& built = *modules_.emplace_back(std::make_unique<Module>());
  built.member = wanted.rs485 ? *wanted.rs485 : member_modules_.size();
  if (!wanted.rs485) member_modules_.emplace_back();
  member_modules_[built.member].push_back(index);
  if (wanted.can) {
    Bus& bus = *buses_[*wanted.can];
    built.can = &bus.bus->connect();
    bus.members.push_back(built.member);
  } else if (wanted.doors.has_can()) {
    built.own_can = std::make_shared<SharedCanPort>();
    built.can = built.own_can.get();
  }
  Result<OpenDoors> doors = OpenDoors::open(events_, wanted.doors, description_.tcp_address, nullptr, built.own_can,
                                            serving(built.member), clock_);
  if (!doors) return doors.error();
  built.doors.emplace(std::move(*doors));
  if (!wanted.eeprom.empty()) {
    Result<std::unique_ptr<KeptEeprom>> kept = KeptEeprom::open(wanted.eeprom, *wanted.kind);
    if (!kept) return kept.error();
    built.eeprom = std::move(*kept);
  }

  std::vector<hal::Port> ports{{&built.setup_line.port(), hal::PortKind::usb}};
  const auto plug_in = [&](RequestPort* port, hal::PortKind kind) {
    if (port == nullptr) return;
    hal::BytePort* bytes = port;
    if (wanted.wire) {
      bytes = built.wires.emplace_back(std::make_unique<PacedPort>(*port, kind, *wanted.wire)).get();
    }
    ports.push_back({bytes, kind});
  };
  plug_in(built.doors->pty_port(), wanted.link_kind);
  plug_in(built.doors->tcp_port(), hal::PortKind::usb);
  if (wanted.rs485) ports.push_back({&lines_[*wanted.rs485]->line.connect(), hal::PortKind::rs485});

  VirtualModule::Options board = wanted.bench->board();
  board.can = built.can;
  board.tables = tables_;
  built.module = std::make_unique<VirtualModule>(*wanted.kind, std::move(ports), board);
  wanted.bench->write_initial(built.module->world());
  for (const auto& wire : built.wires) wire->connect(*built.module);
  if (wanted.rs485) lines_[*wanted.rs485]->line.add(*built.module);
  return built.eeprom ? built.eeprom->load(*built.module) : Result<void>();
}

Simulated& FarmSite::simulated_of(std::size_t index) {
  const std::optional<std::size_t>& line = description_.modules[index].rs485;
  return line ? static_cast<Simulated&>(lines_[*line]->line) : *modules_[index]->module;
}

Result<void> FarmSite::set_up_module(std::size_t index) {
  const FarmModule& wanted = description_.modules[index];
  Module& built = *modules_[index];
  Simulated& simulated = simulated_of(index);
  BusSettings settings;
  settings.serial_address = wanted.address;
  if (built.can != nullptr) settings.can_id = wanted.address;
  if (wanted.rs485) settings.rs485_baud_rate = description_.rs485_lines[*wanted.rs485].baud_rate;
  if (wanted.can) settings.can_bit_rate = description_.can_buses[*wanted.can].bit_rate;
  if (Result<void> done = set_up(simulated, *built.module, built.setup_line, settings); !done) return done;
  if (wanted.program.empty()) return {};
  return load_program(simulated, built.setup_line, *wanted.kind, programs_(wanted), wanted.starts_program);
}

void FarmSite::build_farm(Farm::Options options) {
  farm_ = std::make_unique<Farm>(events_, member_modules_.size(), options, clock_);
  for (std::size_t member = 0; member < member_modules_.size(); ++member) {
    std::vector<const RequestQueue*> requests;
    const auto add = [&requests](const RequestQueue* queue) {
      if (queue != nullptr) requests.push_back(queue);
    };
    bool is_paced = member < lines_.size();
    if (is_paced) add(lines_[member]->port.get());
    for (const std::size_t index : member_modules_[member]) {
      Module& module = *modules_[index];
      add(module.doors->pty_port());
      add(module.doors->tcp_port());
      add(module.can);
      is_paced = is_paced || !module.wires.empty();
    }
    Simulated& simulated = member < lines_.size() ? static_cast<Simulated&>(lines_[member]->line)
                                                  : *modules_[member_modules_[member].front()]->module;
    farm_->set(member, simulated, std::move(requests), is_paced);
  }
  keeps_eeproms_.resize(member_modules_.size());
  for (const std::unique_ptr<Module>& module : modules_) {
    if (module->eeprom) keeps_eeproms_[module->member] = true;
  }
  farm_->after_turn([this](std::size_t member) { save(member); });
}

void FarmSite::save(std::size_t member) {
  if (!keeps_eeproms_[member]) return;
  for (const std::size_t index : member_modules_[member]) {
    Module& module = *modules_[index];
    if (!module.eeprom) continue;
    Result<void> saved = module.eeprom->save(*module.module);
    if (saved.ok()) continue;
    outcome_ = named(description_.modules[index].name, saved.error());
    farm_->stop();
  }
}

Result<void> FarmSite::finish() {
  for (std::size_t i = 0; i < modules_.size(); ++i) {
    Module& module = *modules_[i];
    if (!module.eeprom) continue;
    let_eeprom_rest(simulated_of(i), *module.module);
    save(module.member);
  }
  return outcome_;
}

VirtualModule& FarmSite::module(std::size_t index) {
  return *modules_[index]->module;
}

std::vector<FarmSite::Place> FarmSite::places() const {
  std::vector<Place> places;
  for (std::size_t i = 0; i < modules_.size(); ++i) {
    const FarmModule& wanted = description_.modules[i];
    Place place{wanted.kind->name, &wanted.name, &*modules_[i]->doors};
    if (wanted.rs485) place.bus = &description_.rs485_lines[*wanted.rs485].name;
    if (wanted.can) place.bus = &description_.can_buses[*wanted.can].name;
    if (place.bus != nullptr) place.address = wanted.address.value_or(default_address);
    places.push_back(place);
  }
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    places.push_back({"RS485", &description_.rs485_lines[i].name, &*lines_[i]->doors, true});
  }
  for (std::size_t i = 0; i < buses_.size(); ++i) {
    places.push_back({"CAN", &description_.can_buses[i].name, &*buses_[i]->doors, true});
  }
  return places;
}

}  // namespace opentmcl::server
