#include "pico/stdlib.h"
void pwm_set_wrap(unsigned int slice, uint16_t wrap);
void pwm_set_enabled(unsigned int slice, bool enabled);
void pwm_set_both_levels(unsigned int slice, uint16_t a, uint16_t b);
