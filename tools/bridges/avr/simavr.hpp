// SPDX-License-Identifier: Apache-2.0
#pragma once

// simavr's headers are C.
#include <cstdint>
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wconversion"
#include <sim_avr.h>
//
#include <avr_acomp.h>
#include <avr_adc.h>
#include <avr_eeprom.h>
#include <avr_extint.h>
#include <avr_ioport.h>
#include <avr_timer.h>
#include <avr_uart.h>
#include <avr_watchdog.h>
#pragma GCC diagnostic pop
