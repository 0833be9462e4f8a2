#include "pico/stdlib.h"
void adc_init(void);
void adc_gpio_init(uint pin);
uint16_t adc_read(void);
