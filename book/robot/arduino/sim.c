/* A board with an ATmega328P on a robot, by simavr: what arduino_run.py calls through ctypes.
   A QMC5883L answers on its bus, a receiver's bytes come in at their baud, two quadrature
   encoders turn as they are told, and the pins of motors and relay are read. */
#include <simavr/avr_adc.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_twi.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { QUEUE = 4096, PAINT = 0xA5, TURNS_FOREVER = 0xCFFF /* rjmp .-2 */ };
enum { PORTB = 0x25, PORTC = 0x28, TCCR1A = 0x80, OCR1A = 0x88, OCR1B = 0x8A,
       TWSR = 0xB9, TWCR = 0xBC };

static avr_t *avr;
static elf_firmware_t firmware;
static uint8_t queue[QUEUE], said[QUEUE];
static int first, waiting, heard;
static uint32_t byte_cycles;

static struct {
  int selected, count, place;
  uint8_t registers[16];
} compass;
static struct {
  double from, rate; /* quarter steps, and per cycle */
  int64_t now;
  avr_irq_t *a, *b;
} wheels[2];
static avr_cycle_count_t since;
static avr_run_t runs; /* simavr's function, until its watchdog puts a reset in its place */

/* What Python sets before a run: field ahead and to the left, counts; battery, mV; 1 or 0. */
static struct { int16_t x, y; int compass, millivolts; } world;

/* A program that hangs loses bytes; every other error is worth a line. */
static void log_error(avr_t *board, const int level, const char *format, va_list list) {
  (void)board;
  if (level <= LOG_ERROR && !strstr(format, "overrun")) vfprintf(stderr, format, list);
}

static void no_sleep(avr_t *board, avr_cycle_count_t cycles) { (void)board, (void)cycles; }

/* The bus: a compass that takes a place, then bytes to write there, or gives those from there. */
static void on_bus(avr_irq_t *irq, uint32_t value, void *given) {
  avr_twi_msg_irq_t told = {.u.v = value};
  avr_irq_t *back = avr_io_getirq(avr, AVR_IOCTL_TWI_GETIRQ(0), TWI_IRQ_INPUT);
  uint8_t *registers = compass.registers;
  (void)irq, (void)given;
  if (told.u.twi.msg & TWI_COND_STOP) compass.selected = 0;
  if (told.u.twi.msg & TWI_COND_START) {
    compass.selected = world.compass && told.u.twi.addr >> 1 == 0x0D, compass.count = 0;
    if (compass.selected) avr_raise_irq(back, avr_twi_irq_msg(TWI_COND_ACK, told.u.twi.addr, 1));
  }
  if (!compass.selected) return;
  if (told.u.twi.msg & TWI_COND_WRITE) {
    avr_raise_irq(back, avr_twi_irq_msg(TWI_COND_ACK, told.u.twi.addr, 1));
    if (compass.count++) registers[compass.place++ & 15] = told.u.twi.data;
    else compass.place = told.u.twi.data;
  }
  if (told.u.twi.msg & TWI_COND_READ) {
    registers[6] = registers[9] & 1; /* new, if it was told to measure */
    memcpy(registers, &world.x, 2), memcpy(registers + 2, &world.y, 2);
    avr_raise_irq(back, avr_twi_irq_msg(TWI_COND_READ, told.u.twi.addr,
                                        registers[compass.place++ & 15]));
  }
}

/* simavr 1.6 does not clear TWINT when a program writes it, and says 0x28 of an address too. */
static void on_control(avr_t *board, avr_io_addr_t place, uint8_t value, void *given) {
  (void)value, (void)given;
  board->data[place] &= 0x7F;
}
static void on_status(avr_irq_t *irq, uint32_t value, void *given) {
  (void)irq, (void)given;
  if (value == 0x28 && !compass.count) avr->data[TWSR] = 0x18;
}

static void on_letter(avr_irq_t *irq, uint32_t value, void *given) {
  (void)irq, (void)given;
  if (heard < QUEUE) said[heard++] = (uint8_t)value;
}

static void on_battery(avr_irq_t *irq, uint32_t value, void *given) {
  (void)irq, (void)value, (void)given;
  avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC1), world.millivolts);
}

static avr_cycle_count_t next_byte(avr_t *board, avr_cycle_count_t when, void *given) {
  (void)board, (void)given;
  if (!waiting) return 0;
  avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT), queue[first]);
  first = (first + 1) % QUEUE, --waiting;
  return when + byte_cycles;
}

/* The wheel's next quarter step, and when the one after it is. */
static avr_cycle_count_t next_step(avr_t *board, avr_cycle_count_t when, void *given) {
  const int side = (int)(intptr_t)given, ahead = wheels[side].rate > 0 ? 1 : -1;
  double left;
  (void)board;
  if (when > since) { /* not when it is only planned */
    wheels[side].now += ahead;
    avr_raise_irq(wheels[side].a, ((wheels[side].now + 1) >> 1) & 1); /* ahead, a leads */
    avr_raise_irq(wheels[side].b, (wheels[side].now >> 1) & 1);
  }
  if (wheels[side].rate == 0) return 0;
  left = ((double)wheels[side].now + ahead - wheels[side].from) / wheels[side].rate;
  return since + 1 + (avr_cycle_count_t)(left > 0 ? left : 0);
}

static avr_cycle_count_t end_of_run(avr_t *board, avr_cycle_count_t when, void *given) {
  (void)board, (void)when, (void)given;
  return 0; /* it is enough that a sleep ends here */
}

/* Loads a program; 0 if it can't be. */
int sim_open(const char *path, uint32_t baud) {
  static const char ports[] = {'D', 'D', 'D', 'D'};
  static const int pins[] = {2, 4, 3, 7};
  avr_global_logger_set(log_error);
  memset(&firmware, 0, sizeof firmware), memset(&compass, 0, sizeof compass);
  memset(wheels, 0, sizeof wheels), first = waiting = heard = 0, since = 0;
  if (elf_read_firmware(path, &firmware) || !(avr = avr_make_mcu_by_name("atmega328p"))) return 0;
  avr_init(avr);
  firmware.frequency = 16000000, avr_load_firmware(avr, &firmware);
  avr->sleep = no_sleep, runs = avr->run, avr->vcc = avr->avcc = avr->aref = 5000;
  byte_cycles = 10 * 16000000 / baud;
  memset(avr->data + 0x100 + firmware.datasize + firmware.bsssize, PAINT,
         avr->ramend + 1 - (0x100 + firmware.datasize + firmware.bsssize));
  uint32_t quiet = 0;
  avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &quiet);
  avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT),
                          on_letter, NULL);
  avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_TWI_GETIRQ(0), TWI_IRQ_OUTPUT), on_bus,
                          NULL);
  avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_OUT_TRIGGER),
                          on_battery, NULL);
  avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_TWI_GETIRQ(0), TWI_IRQ_STATUS), on_status,
                          NULL);
  avr_register_io_write(avr, TWCR, on_control, NULL);
  for (int k = 0; k < 4; ++k) {
    avr_irq_t *pin = avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ(ports[k]), pins[k]);
    *(k % 2 ? &wheels[k / 2].b : &wheels[k / 2].a) = pin;
  }
  return 1;
}

void sim_send(const uint8_t *bytes, int count) {
  for (int k = 0; k < count && waiting < QUEUE; ++k)
    queue[(first + waiting++) % QUEUE] = bytes[k];
  if (waiting && !avr_cycle_timer_status(avr, next_byte, NULL)) /* a reset cancels timers */
    avr_cycle_timer_register(avr, byte_cycles, next_byte, NULL);
}

/* Runs for so many cycles, while the encoders turn to `left` and `right` quarter steps. Returns 0
   when the watchdog has reset the board, which is to be opened again, as simavr 1.6 does not reset
   timers well; else simavr's state: 2 and 3, running and asleep, are sound. */
int sim_run(uint32_t cycles, double left, double right, int x, int y, int answers,
            int open, int millivolts) {
  const double to[2] = {left, right};
  const avr_cycle_count_t end = since + cycles;
  int state = avr->state;
  world.x = (int16_t)x, world.y = (int16_t)y, world.compass = answers;
  world.millivolts = millivolts;
  avr_ioport_external_t button = {.name = 'B', .mask = 0x10, .value = open ? 0x10 : 0};
  avr_ioctl(avr, AVR_IOCTL_IOPORT_SET_EXTERNAL('B'), &button);
  avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('B'), 4), open != 0);
  for (intptr_t side = 0; side < 2; ++side) {
    avr_cycle_timer_cancel(avr, next_step, (void *)side);
    wheels[side].rate = (to[side] - wheels[side].from) / cycles;
    const avr_cycle_count_t next = next_step(avr, since, (void *)side);
    if (next) avr_cycle_timer_register(avr, next > avr->cycle ? next - avr->cycle : 1, next_step,
                                       (void *)side);
  }
  if (avr->cycle < end) avr_cycle_timer_register(avr, end - avr->cycle, end_of_run, NULL);
  while (avr->cycle < end && state != cpu_Done && state != cpu_Crashed) {
    if (avr->run != runs) return 0;
    state = avr_run(avr);
  }
  for (int side = 0; side < 2; ++side) wheels[side].from = to[side];
  since = end;
  return state;
}

/* The letters that it sent since the last call. */
int sim_said(uint8_t *to, int most) {
  const int count = heard < most ? heard : most;
  memcpy(to, said, (size_t)count), heard = 0;
  return count;
}

/* Duty of left and right, -1 to 1, and whether the relay is closed. */
void sim_pins(double *out) {
  const uint8_t *data = avr->data, port = data[PORTB];
  const double duty[] = {data[TCCR1A] & 0x80 ? data[OCR1A] / 255.0 : port >> 1 & 1,
                         data[TCCR1A] & 0x20 ? data[OCR1B] / 255.0 : port >> 2 & 1};
  out[0] = port & 1 ? -duty[0] : duty[0], out[1] = port >> 3 & 1 ? -duty[1] : duty[1];
  out[2] = data[PORTC] & 1;
}

/* The program hangs where it is, in an endless loop. */
void sim_hang(void) {
  const uint16_t loop = TURNS_FOREVER;
  memcpy(avr->flash + avr->pc, &loop, 2);
}

/* Bytes of RAM that the stack never reached. */
int sim_untouched(void) {
  int count = 0;
  for (int at = 0x100 + (int)(firmware.datasize + firmware.bsssize);
       at <= avr->ramend && avr->data[at] == PAINT; ++at)
    ++count;
  return count;
}
