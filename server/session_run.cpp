#include "server/session_run.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "scenario/condition.hpp"

namespace opentmcl::server {

using client::Error;
using client::Result;

namespace {

/// Simulated time between two checks, within which a replay can tell where it departs: a second, and a thousandth of a
/// long session. The checks of an hour take 100 KB, those of a year that is simulated flat out 600 KB.
Microseconds check_interval(Microseconds age) {
  constexpr Microseconds shortest = 1'000'000;
  return std::max(shortest, age / 1000);
}

std::string seconds(Microseconds time) {
  return std::to_string(static_cast<double>(time) / 1'000'000) + " s";
}

}  // namespace

/// A serial port of the module.
class Session::Run::Port final : public hal::BytePort {
 public:
  Port(Run& run, unsigned number) : run_(run), number_(number) {}

  void connect(hal::BytePort* outside) {
    outside_ = outside;
    if (outside_ != nullptr) outside_->set_text_mode(text_mode_);
  }

  std::size_t read(std::uint8_t* buffer, std::size_t capacity) override {
    if (run_.source_ != nullptr) return read_replayed(buffer, capacity);
    const std::size_t count = outside_ != nullptr ? outside_->read(buffer, capacity) : 0;
    if (count > 0) run_.note({run_.module_->now(), BytesRead{number_, {buffer, buffer + count}}});
    return count;
  }

  void write(const std::uint8_t* data, std::size_t length) override {
    run_.replies_.add(std::uint64_t{number_});
    run_.replies_.add({data, length});
    if (outside_ != nullptr) outside_->write(data, length);
  }

  void set_text_mode(bool text) override {
    text_mode_ = text;
    if (outside_ != nullptr) outside_->set_text_mode(text);
  }

 private:
  std::size_t read_replayed(std::uint8_t* buffer, std::size_t capacity) {
    const auto* read = run_.replayed<BytesRead>();
    if (read == nullptr || read->port != number_ || read->bytes.size() > capacity) return 0;
    const std::size_t count = read->bytes.size();
    std::copy(read->bytes.begin(), read->bytes.end(), buffer);
    run_.take_replayed();
    return count;
  }

  Run& run_;
  unsigned number_;
  hal::BytePort* outside_ = nullptr;
  bool text_mode_ = false;
};

/// Its connector to CAN.
class Session::Run::CanLine final : public hal::CanPort {
 public:
  explicit CanLine(Run& run) : run_(run) {}

  void connect(hal::CanPort* outside) {
    outside_ = outside;
    if (outside_ != nullptr && bit_rate_) outside_->join(*bit_rate_);
  }

  void join(std::uint32_t bit_rate) override {
    bit_rate_ = bit_rate;
    if (outside_ != nullptr) outside_->join(bit_rate);
  }

  bool read(hal::CanFrame& frame) override {
    if (run_.source_ != nullptr) return read_replayed(frame);
    if (outside_ == nullptr || !outside_->read(frame)) return false;
    run_.note({run_.module_->now(), FrameRead{frame}});
    return true;
  }

  void write(const hal::CanFrame& frame) override {
    constexpr std::uint64_t can_port = 0xCA;  // other than the number of any serial port
    run_.replies_.add(can_port);
    run_.replies_.add(std::uint64_t{frame.id} << 1 | (frame.is_extended ? 1 : 0));
    run_.replies_.add({frame.data, frame.length});
    if (outside_ != nullptr) outside_->write(frame);
  }

 private:
  bool read_replayed(hal::CanFrame& frame) {
    const auto* read = run_.replayed<FrameRead>();
    if (read == nullptr) return false;
    frame = read->frame;
    run_.take_replayed();
    return true;
  }

  Run& run_;
  hal::CanPort* outside_ = nullptr;
  std::optional<std::uint32_t> bit_rate_;
};

Session::Run::Run(SessionSetup setup, scenario::Scenario scenario, std::optional<SessionLog> log,
                  const Options& options, std::shared_ptr<twin::TorqueTables> tables)
    : setup_(std::move(setup)), scenario_(std::move(scenario)), log_(std::move(log)), options_(options) {
  std::vector<hal::Port> ports;
  for (const SessionSetup::Port& port : setup_.ports) {
    hal::BytePort* bytes =
        ports_.emplace_back(std::make_unique<Port>(*this, static_cast<unsigned>(ports_.size()))).get();
    if (port.wire != 0) bytes = wires_.emplace_back(std::make_unique<PacedPort>(*bytes, port.kind, port.wire)).get();
    ports.push_back({bytes, port.kind});
  }
  VirtualModule::Options board = scenario_.board();
  board.turn = setup_.turn;
  board.tables = std::move(tables);
  if (setup_.has_can) {
    can_ = std::make_unique<CanLine>(*this);
    board.can = can_.get();
  }
  board.extra_turns = this;
  if (options.observer != nullptr) listeners_.add(*options.observer);
  module_ = std::make_unique<VirtualModule>(*setup_.module, std::move(ports), board,
                                            listeners_.empty() ? nullptr : &listeners_);
  for (const auto& wire : wires_) wire->connect(*module_);
  scenario_.write_initial(module_->world());
  module_->world().eeprom().load(setup_.eeprom);
  module_->advance_to(module_->now());
}

Session::Run::~Run() {
  // What could not be written has nobody left to be told to.
  for (const auto& [number, recording] : recordings_) static_cast<void>(recording->close());
}

void Session::Run::connect(const Doors& doors) {
  for (std::size_t i = 0; i < ports_.size() && i < doors.ports.size(); ++i) ports_[i]->connect(doors.ports[i]);
  if (can_) can_->connect(doors.can);
}

void Session::Run::note(const SessionEvent& event) {
  if (log_ && !is_finished_) log_->write(event);
}

void Session::Run::extra_turn(Microseconds now) {
  note({now, ExtraTurn{}});
}

// ---- The scenario and recordings

void Session::Run::begin(Microseconds duration) {
  note({module_->now(), ScenarioBegun{duration}});
  scenario_.duration = duration;
  scenario_run_.emplace(scenario_, *module_, [this](const scenario::Report& what) { report(what); });
  module_->add_actor(*scenario_run_);
  // After those who change something.
  if (options_.recording != nullptr) start(*options_.recording);
  module_->advance_to(module_->now());
}

void Session::Run::report(const scenario::Report& what) {
  // Exactly here: whoever is told ends the simulation a little later, nobody knows when.
  if (what.kind == scenario::Report::Kind::end && options_.recording != nullptr) options_.recording->stop();
  if (speaks_ && options_.listener) options_.listener(setup_, what);
}

void Session::Run::start(SignalRecording& recording) {
  listeners_.add(recording.observer());
  module_->world().observe(&listeners_);
  recording.start(*module_);
}

Result<void> Session::Run::close(SignalRecording& recording) {
  Result<void> closed = recording.close();
  listeners_.remove(recording.observer());
  if (listeners_.empty()) module_->world().observe(nullptr);
  return closed;
}

std::uint64_t Session::Run::start_recording(std::unique_ptr<SignalRecording> recording) {
  start(*recording);
  recordings_.emplace(++last_recording_, std::move(recording));
  return last_recording_;
}

Result<std::string> Session::Run::stop_recording(std::uint64_t number) {
  const auto found = recordings_.find(number);
  if (found == recordings_.end()) {
    return Error{client::ErrorKind::usage, "there is no recording " + std::to_string(number), {}};
  }
  const std::unique_ptr<SignalRecording> recording = std::move(found->second);
  recordings_.erase(found);
  if (Result<void> closed = close(*recording); !closed) return closed.error();
  return recording->path();
}

Result<void> Session::Run::finish() {
  if (scenario_run_) scenario_run_->finish(*module_);
  note({module_->now(), SessionEnd{check()}});
  is_finished_ = true;
  if (log_) log_->flush();
  Result<void> outcome;
  if (options_.recording != nullptr) outcome = close(*options_.recording);
  for (const auto& [number, recording] : recordings_) {
    if (Result<void> closed = close(*recording); !closed) outcome = closed;
  }
  recordings_.clear();
  module_->world().observe(nullptr);
  return outcome;
}

// ---- What a person at the bench can do

void Session::Run::set(const std::vector<QuantitiesSet::Value>& values) {
  note({module_->now(), QuantitiesSet{values}});
  for (const auto& [name, value] : values) twin::find_quantity(name)->write(module_->world(), value);
  module_->advance_to(module_->now());
}

void Session::Run::power_cycle() {
  note({module_->now(), PowerCycled{}});
  module_->power_cycle();
  module_->advance_to(module_->now());
}

Check Session::Run::check() const {
  return {replies_.value(), twin::digest_of(module_->world())};
}

void Session::Run::check_now_and_then() {
  if (!log_ || module_->now() < last_check_ + check_interval(last_check_)) return;
  last_check_ = module_->now();
  note({last_check_, check()});
  log_->flush();
}

// ---- Replay

template <class What>
const What* Session::Run::replayed() const {
  const std::optional<SessionEvent>& next = source_->next();
  return next && next->time == module_->now() ? std::get_if<What>(&next->what) : nullptr;
}

void Session::Run::take_replayed() {
  note(*source_->next());
  source_->take();
}

Result<void> Session::Run::replay(SessionLogReader& source) {
  source_ = &source;
  std::optional<Error> failure;
  while (source.next() && !failure) {
    // A copy: what is repeated is taken off the source.
    const SessionEvent event = *source.next();
    failure = repeat(event);
  }
  source_ = nullptr;
  if (!failure) failure = source.failure();
  return failure ? Result<void>(*failure) : Result<void>();
}

std::optional<Error> Session::Run::repeat(const SessionEvent& event) {
  const std::size_t line = source_->line();
  const Microseconds time = event.time;
  module_->advance_to(time);
  // Taken by the firmware on the way there.
  if (source_->line() != line || !source_->next()) return std::nullopt;

  struct Repeat {
    Run& run;
    std::optional<Error> operator()(const ExtraTurn&) {
      run.source_->take();
      run.module_->wake();
      run.module_->advance_to(run.module_->now());
      return std::nullopt;
    }
    std::optional<Error> operator()(const QuantitiesSet& set) {
      for (const auto& [name, value] : set.values) {
        const twin::Quantity* quantity = twin::find_quantity(name);
        if (quantity == nullptr) return run.source_->error_here(scenario::no_such_quantity(name));
        if (const auto refusal = twin::refusal(*quantity, run.module_->world(), value)) {
          return run.source_->error_here(name + " " + *refusal);
        }
      }
      run.source_->take();
      run.set(set.values);
      return std::nullopt;
    }
    std::optional<Error> operator()(const ScenarioBegun& begun) {
      if (run.scenario_run_) return run.source_->error_here("the scenario begins a second time");
      run.source_->take();
      run.begin(begun.duration);
      return std::nullopt;
    }
    std::optional<Error> operator()(const PowerCycled&) {
      run.source_->take();
      run.power_cycle();
      return std::nullopt;
    }
    std::optional<Error> operator()(const Check& check) {
      if (auto difference = run.expect(check)) return difference;
      run.last_check_ = run.module_->now();
      run.take_replayed();
      return std::nullopt;
    }
    std::optional<Error> operator()(const SessionEnd& end) {
      if (auto difference = run.expect(end.check)) return difference;
      run.source_->take();
      return std::nullopt;
    }
    std::optional<Error> operator()(const BytesRead&) { return not_read(); }
    std::optional<Error> operator()(const FrameRead&) { return not_read(); }

    std::optional<Error> not_read() {
      return run.source_->error_here("at " + seconds(run.module_->now()) +
                                     " the firmware read something then and does not now");
    }
  };
  return std::visit(Repeat{*this}, event.what);
}

std::optional<Error> Session::Run::expect(const Check& recorded) {
  const Check now = check();
  if (now == recorded) return std::nullopt;
  const char* what = now.replies != recorded.replies ? "the replies" : "the state of the world";
  return source_->error_here(std::string("up to ") + seconds(module_->now()) + " " + what +
                             " departed from the recorded session, after the last check before this line");
}

}  // namespace opentmcl::server
