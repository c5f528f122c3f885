// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/avr/core.hpp"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "tools/bridges/avr/simavr.hpp"

namespace cohort::avr {
namespace {

constexpr std::size_t most_notes = 20;
constexpr std::uint32_t largest_frequency = 40'000'000;

std::string hexadecimal(std::uint32_t number) {
  std::array<char, 12> text{};
  std::snprintf(text.data(), text.size(), "0x%04x", number);
  return text.data();
}

// simavr has a parity bit in every byte of a serial interface, whether the firmware wants one or not.
void correct_time_of_byte(avr_irq_t*, std::uint32_t, void* serial) {
  auto* uart = static_cast<avr_uart_t*>(serial);
  avr_t* avr = uart->io.avr;
  constexpr unsigned parity_bits = 0x30;
  const std::array<unsigned, 8> data_bits{5, 6, 7, 8, 8, 8, 8, 9};
  const unsigned size = avr_regbit_get(avr, uart->ucsz) | avr_regbit_get(avr, uart->ucsz2) << 2U;
  const unsigned bits = 1 + data_bits[size & 7U] + ((avr->data[uart->r_ucsrc] & parity_bits) != 0 ? 1U : 0U) + 1 +
                        avr_regbit_get(avr, uart->usbs);
  const unsigned divisor = avr_regbit_get(avr, uart->ubrrl) | avr_regbit_get(avr, uart->ubrrh) << 8U;
  uart->cycles_per_byte = (divisor + 1U) * (avr_regbit_get(avr, uart->u2x) != 0 ? 8U : 16U) * bits;
}

unsigned prescaler_of(avr_watchdog_t& watchdog) {
  return avr_regbit_get_array(watchdog.io.avr, watchdog.wdp, static_cast<int>(std::size(watchdog.wdp)));
}

Core* core_of(const avr_t* avr) { return static_cast<Core*>(avr->custom.data); }

// The ATmega328 and its variants of lower power run each other's images.
std::string family_of(std::string mcu) {
  if (mcu.starts_with("atmega") && mcu.size() > 7 && (mcu.ends_with('p') || mcu.ends_with('a'))) mcu.pop_back();
  return mcu;
}

}  // namespace

Core::Core(const Image& image, Chip chip) : chip_(std::move(chip)) {
  if (chip_.frequency == 0 || chip_.frequency > largest_frequency)
    throw std::runtime_error("expected a frequency between 1 Hz and 40 MHz, not " + std::to_string(chip_.frequency) +
                             " Hz");
  if (!image.mcu.empty() && family_of(image.mcu) != family_of(chip_.mcu))
    throw std::runtime_error(image.file + ": the image is for an " + image.mcu + ", not for an " + chip_.mcu);
  static std::once_flag once;
  std::call_once(once, [] { avr_global_logger_set(&Core::log); });
  avr_ = avr_make_mcu_by_name(chip_.mcu.c_str());
  if (avr_ == nullptr)
    throw std::runtime_error("simavr has no microcontroller '" + chip_.mcu +
                             "': expected, for example, atmega328p, atmega2560 or atmega32u4");
  avr_init(avr_);
  avr_->custom.data = this;
  avr_->frequency = chip_.frequency;
  const auto millivolts = static_cast<std::uint32_t>(chip_.supply * 1000.0 + 0.5);
  avr_->vcc = avr_->avcc = avr_->aref = millivolts;
  try {
    load(image);
  } catch (...) {
    avr_terminate(avr_);
    std::free(avr_);
    throw;
  }
  enlarge_memories();
  connect();
}

Core::~Core() {
  avr_terminate(avr_);
  std::free(avr_);
}

void Core::load(const Image& image) {
  const std::uint32_t flash_size = avr_->flashend + 1;
  for (const Segment& segment : image.flash) {
    const std::uint64_t end = std::uint64_t{segment.address} + segment.bytes.size();
    if (end > flash_size)
      throw std::runtime_error(image.file + ": the program ends at address " +
                               hexadecimal(static_cast<std::uint32_t>(end)) + ", but the flash memory of an " +
                               chip_.mcu + " ends at " + hexadecimal(flash_size));
    std::memcpy(avr_->flash + segment.address, segment.bytes.data(), segment.bytes.size());
  }
  for (const Segment& segment : image.eeprom) {
    if (segment.address + segment.bytes.size() > avr_->e2end + 1U)
      throw std::runtime_error(image.file + ": its data does not fit into the EEPROM of an " + chip_.mcu);
    avr_eeprom_desc_t place{const_cast<std::uint8_t*>(segment.bytes.data()),
                            static_cast<std::uint16_t>(segment.address),
                            static_cast<std::uint32_t>(segment.bytes.size())};
    avr_ioctl(avr_, AVR_IOCTL_EEPROM_SET, &place);
  }
}

// Firmware may read and write anywhere that its instructions reach; simavr looks after each access whether it was one
// to a memory that there is.
void Core::enlarge_memories() {
  constexpr std::size_t data_reach = 0x10000, flash_reach = 0x10000, extended_flash_reach = 0x1000000, margin = 4;
  auto* data = static_cast<std::uint8_t*>(std::calloc(data_reach + margin, 1));
  auto* flash = static_cast<std::uint8_t*>(std::calloc(
      (avr_->rampz != 0 || avr_->flashend >= flash_reach ? extended_flash_reach : flash_reach) + margin, 1));
  if (data == nullptr || flash == nullptr) throw std::bad_alloc();
  std::memcpy(data, avr_->data, avr_->ramend + 1U);
  std::memcpy(flash, avr_->flash, avr_->flashend + 1U);
  // simavr's own instruction after the end, which begins again at 0 and says so on standard output, is left out.
  std::free(std::exchange(avr_->data, data));
  std::free(std::exchange(avr_->flash, flash));
}

void Core::connect() {
  // It neither waits for the time of the wall nor writes what its serial interfaces send to our standard output.
  avr_->sleep = [](avr_t*, avr_cycle_count_t) {};
  run_of_chip_ = avr_->run;
  reset_of_chip_ = std::exchange(avr_->reset, [](avr_t* avr) { core_of(avr)->on_reset(); });
  for (const char name : {'0', '1', '2', '3'}) {
    std::uint32_t flags = 0;
    avr_ioctl(avr_, static_cast<std::uint32_t>(AVR_IOCTL_UART_SET_FLAGS(name)), &flags);
  }
  for (avr_io_t* module = avr_->io_port; module != nullptr; module = module->next) {
    if (std::strcmp(module->kind, "usb") == 0) disconnect_usb();
    if (std::strcmp(module->kind, "watchdog") == 0) connect_watchdog(reinterpret_cast<avr_watchdog_t*>(module));
    if (std::strcmp(module->kind, "uart") != 0) continue;
    auto* uart = reinterpret_cast<avr_uart_t*>(module);
    const std::array<unsigned, 4> registers{uart->ubrrl.reg, uart->ubrrh.reg, uart->r_ucsra, uart->r_ucsrc};
    for (const unsigned address : registers)
      if (address != 0)
        avr_irq_register_notify(avr_iomem_getirq(avr_, static_cast<avr_io_addr_t>(address), nullptr, AVR_IOMEM_IRQ_ALL),
                                correct_time_of_byte, uart);
  }
  watch_edges_only();
  outputs_ = std::make_unique<Outputs>(avr_, chip_.mcu);
  arm();
}

// A pin of an interrupt by level, which all are after a reset, would be looked at in each cycle while it is low.
void Core::watch_edges_only() {
  for (std::uint8_t number = 0; number < EXTINT_COUNT; ++number) avr_extint_set_strict_lvl_trig(avr_, number, 0);
}

// A new prescaler has an effect at once. In simavr, it has none before the next instruction `wdr` if the watchdog is on
// already, as it is after it has reset the chip.
void Core::connect_watchdog(avr_watchdog_t* watchdog) {
  watchdog_ = watchdog;
  const auto on_write = [](avr_irq_t*, std::uint32_t, void* its) {
    auto* core = static_cast<Core*>(its);
    const unsigned prescaler = prescaler_of(*core->watchdog_);
    if (std::exchange(core->watchdog_prescaler_, prescaler) != prescaler)
      avr_ioctl(core->avr_, AVR_IOCTL_WATCHDOG_RESET, nullptr);
  };
  avr_irq_register_notify(
      avr_iomem_getirq(avr_, static_cast<avr_io_addr_t>(watchdog->wdce.reg), nullptr, AVR_IOMEM_IRQ_ALL), on_write,
      this);
}

// simavr ends the process where firmware accesses the endpoints of USB in another way than it knows. With no computer
// at the other end they are memory.
void Core::disconnect_usb() {
  constexpr avr_io_addr_t first_of_endpoints = 0xe8, last_of_endpoints = 0xf4;  // UEINTX to UEINT, data sheet
  for (unsigned address = first_of_endpoints; address <= last_of_endpoints; ++address) {
    auto& callbacks = avr_->io[AVR_DATA_TO_IO(address)];
    callbacks.r = {};
    callbacks.w = {};
  }
}

std::uint64_t Core::cycle() const { return avr_->cycle; }
std::uint32_t Core::program_counter() const { return avr_->pc; }

void Core::run_until(std::uint64_t cycle) {
  end_ = cycle;
  arm();
  while (avr_->cycle < cycle) {
    switch (avr_->state) {
      case cpu_Running:
      case cpu_Sleeping:
        avr_run(avr_);
        if (std::exchange(was_reset_, false)) watch_edges_only();
        break;
      case cpu_Done: sleep_for_ever(cycle); break;
      default:
        if (!fault_) on_message("crash");
        avr_->cycle = cycle;
    }
  }
}

// Only the watchdog can wake a core that sleeps with interrupts off, by a reset. Its timers go on meanwhile.
void Core::sleep_for_ever(std::uint64_t cycle) {
  if (!std::exchange(said_that_it_sleeps_, true))
    notes_.push_back("sleeps with interrupts disabled, at pc " + hexadecimal(avr_->pc) + ": only a reset wakes it");
  const avr_cycle_count_t until_next = avr_cycle_timer_process(avr_);
  if (avr_->run != run_of_chip_)
    avr_run(avr_);  // the watchdog's reset
  else
    avr_->cycle = std::min<std::uint64_t>(cycle, avr_->cycle + std::max<std::uint64_t>(until_next, 1));
}

void Core::at(std::uint64_t cycle, std::function<void()> event) {
  events_.emplace(cycle, std::move(event));
  arm();
}

// Sets simavr's timer for the next event or the end of the run, the earlier of both. simavr runs and sleeps no further
// than to its next timer.
void Core::arm() {
  if (in_event_) return;
  // Instructions in one go; without it each needs a call of its own.
  avr_->run_cycle_limit = chip_.frequency;
  const std::uint64_t next = events_.empty() ? end_ : std::min(end_, events_.begin()->first);
  avr_cycle_timer_register(avr_, next > avr_->cycle ? next - avr_->cycle : 1, &Core::wake, this);
}

std::uint64_t Core::wake(avr_t* avr, std::uint64_t, void* core) {
  auto* self = static_cast<Core*>(core);
  self->in_event_ = true;
  while (!self->events_.empty() && self->events_.begin()->first <= avr->cycle) {
    const auto event = std::move(self->events_.begin()->second);
    self->events_.erase(self->events_.begin());
    event();
  }
  self->in_event_ = false;
  const std::uint64_t next = self->events_.empty() ? self->end_ : std::min(self->end_, self->events_.begin()->first);
  return next > avr->cycle ? next : 0;
}

// Called by simavr when its registers are at their initial values, and no timer is left.
void Core::on_reset() {
  if (reset_of_chip_ != nullptr) reset_of_chip_(avr_);
  if (notes_.size() < most_notes) notes_.emplace_back("was reset by its watchdog");
  said_that_it_sleeps_ = false;
  was_reset_ = true;
  watchdog_prescaler_ = 0;
  for (avr_io_t* module = avr_->io_port; module != nullptr; module = module->next) {
    if (std::strcmp(module->kind, "port") != 0) continue;
    // simavr tells of changes only, and does not know that these have changed.
    avr_raise_irq(module->irq + IOPORT_IRQ_REG_PORT, 0);
    avr_raise_irq(module->irq + IOPORT_IRQ_DIRECTION_ALL, 0);
  }
  outputs_->reset();
  for (const auto& [port, driven] : driven_)
    for (int bit = 0; bit < 8; ++bit)
      if ((driven.mask >> bit & 1) != 0) {
        avr_irq_t* irq = pin_irq({port, bit});
        avr_raise_irq(irq, (driven.levels >> bit & 1) == 0);
        avr_raise_irq(irq, driven.levels >> bit & 1);
      }
  for (auto& [number, serial] : serials_) serial->is_full = true;
  arm();
}

avr_irq_t* Core::pin_irq(Pin pin) const {
  avr_irq_t* irq = pin.bit >= 0 && pin.bit < 8
                       ? avr_io_getirq(avr_, static_cast<std::uint32_t>(AVR_IOCTL_IOPORT_GETIRQ(pin.port)), pin.bit)
                       : nullptr;
  if (irq == nullptr) throw std::runtime_error("an " + chip_.mcu + " has no pin " + name_of(pin));
  return irq;
}

void Core::set_input(Pin pin, bool high) {
  avr_irq_t* irq = pin_irq(pin);
  Driven& driven = driven_[pin.port];
  const auto mask = static_cast<std::uint8_t>(1U << static_cast<unsigned>(pin.bit));
  driven.mask = static_cast<std::uint8_t>(driven.mask | mask);
  driven.levels = static_cast<std::uint8_t>(high ? driven.levels | mask : driven.levels & ~mask);
  // Without this the pull-up of the pin would win at the next write to its port.
  avr_ioport_external_t external{};
  external.name = static_cast<unsigned char>(pin.port) & 0x7fU;
  external.mask = driven.mask;
  external.value = driven.levels;
  avr_ioctl(avr_, static_cast<std::uint32_t>(AVR_IOCTL_IOPORT_SET_EXTERNAL(pin.port)), &external);
  avr_raise_irq(irq, high ? 1 : 0);
}

bool Core::input(Pin pin) const {
  const auto driven = driven_.find(pin.port);
  return driven != driven_.end() && (driven->second.levels >> pin.bit & 1) != 0;
}

void Core::set_voltage(int input, double volts) {
  avr_irq_t* irq = input >= 0 && input < 16
                       ? avr_io_getirq(avr_, static_cast<std::uint32_t>(AVR_IOCTL_ADC_GETIRQ), ADC_IRQ_ADC0 + input)
                       : nullptr;
  if (irq == nullptr) throw std::runtime_error("an " + chip_.mcu + " has no analog input " + std::to_string(input));
  const double within = volts > 0.0 ? std::min(volts, chip_.supply) : 0.0;
  avr_raise_irq(irq, static_cast<std::uint32_t>(within * 1000.0 + 0.5));
}

Core::Serial& Core::serial(int number) {
  auto& serial = serials_[number];
  if (serial) return *serial;
  const auto name = static_cast<char>('0' + number);
  const auto control = static_cast<std::uint32_t>(AVR_IOCTL_UART_GETIRQ(name));
  avr_irq_t* output = avr_io_getirq(avr_, control, UART_IRQ_OUTPUT);
  if (number < 0 || number > 9 || output == nullptr) {
    serials_.erase(number);
    throw std::runtime_error("an " + chip_.mcu + " has no serial interface " + std::to_string(number));
  }
  serial = std::make_unique<Serial>();
  serial->input = avr_io_getirq(avr_, control, UART_IRQ_INPUT);
  avr_irq_register_notify(
      output,
      [](avr_irq_t*, std::uint32_t value, void* its) {
        const auto& receive = static_cast<Serial*>(its)->receive;
        if (receive) receive(static_cast<std::uint8_t>(value));
      },
      serial.get());
  const auto on_flow = [](avr_irq_t* irq, std::uint32_t value, void* its) {
    if (value == 0) return;
    static_cast<Serial*>(its)->is_full = irq->irq % UART_IRQ_COUNT == UART_IRQ_OUT_XOFF;
  };
  avr_irq_register_notify(avr_io_getirq(avr_, control, UART_IRQ_OUT_XON), on_flow, serial.get());
  avr_irq_register_notify(avr_io_getirq(avr_, control, UART_IRQ_OUT_XOFF), on_flow, serial.get());
  return *serial;
}

void Core::connect_serial(int number, std::function<void(std::uint8_t)> receive) {
  serial(number).receive = std::move(receive);
}

std::size_t Core::send_serial(int number, std::span<const std::uint8_t> bytes) {
  Serial& to = serial(number);
  std::size_t sent = 0;
  for (; sent < bytes.size() && !to.is_full; ++sent) avr_raise_irq(to.input, bytes[sent]);
  return sent;
}

std::vector<std::string> Core::take_notes() { return std::exchange(notes_, {}); }

void Core::log(avr_t* avr, int level, const char* format, va_list arguments) {
  if (avr == nullptr || level > LOG_ERROR || level < LOG_ERROR || avr->custom.data == nullptr) return;
  std::array<char, 300> text{};
  std::vsnprintf(text.data(), text.size(), format, arguments);
  core_of(avr)->on_message(text.data());
}

// Handles an error message of simavr, or a crash without one.
void Core::on_message(const std::string& text) {
  const auto has = [&text](const char* part) { return text.find(part) != std::string::npos; };
  std::string why;
  if (has("Invalid Opcode"))
    why = "invalid instruction " +
          hexadecimal(static_cast<std::uint32_t>(avr_->flash[avr_->pc] | avr_->flash[avr_->pc + 1] << 8));
  else if (has("Invalid write"))
    why = "it writes to an invalid address";
  else if (has("Invalid read"))
    why = "it reads from an invalid address";
  else if (has("crash"))
    why = "it executed beyond the end of its flash memory";
  else
    return;
  avr_->state = cpu_Crashed;
  if (!fault_) fault_ = why + ", at pc " + hexadecimal(avr_->pc);
}

}  // namespace cohort::avr
