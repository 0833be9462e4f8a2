#pragma once
/* Declarations of the SDK of the Raspberry Pi Pico that the program of the guide uses. */
#include <stdbool.h>
#include <stdint.h>
typedef unsigned int uint;
typedef uint64_t absolute_time_t;
enum gpio_function { GPIO_FUNC_PWM = 4 };
absolute_time_t get_absolute_time(void);
absolute_time_t delayed_by_ms(absolute_time_t time, uint32_t ms);
void sleep_until(absolute_time_t time);
void sleep_us(uint64_t us);
void gpio_init_mask(uint32_t mask);
void gpio_set_dir_out_masked(uint32_t mask);
void gpio_put_masked(uint32_t mask, uint32_t value);
void gpio_set_function(uint pin, enum gpio_function function);
