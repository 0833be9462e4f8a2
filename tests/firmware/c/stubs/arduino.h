/* Declarations of Arduino's library that the sketch of the guide uses. */
#include <stdint.h>
enum { A0 = 54 };
int analogRead(uint8_t pin);
void analogWrite(uint8_t pin, int value);
unsigned long millis(void);
struct Port {
    void begin(unsigned long speed);
    void println(const char *text);
};
extern Port Serial;
