/* A remote hand for Touchstone: two fingertips that rest on the table, and what they feel.
 *
 *   cc -std=c99 -O2 -o client client.c -lm && ./client 127.0.0.1 47474 hand.key 5 [waves]
 *
 * With `waves` the packets carry wave variables (Touchstone must be told so too).
 *
 * C99 and POSIX sockets only; HMAC-SHA-256 is at the end. The packets are described in README.md beside this file.
 * Little-endian machines only (the packets are little-endian and are copied as they are).
 */
#define _POSIX_C_SOURCE 200809L
#include <arpa/inet.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum { MOTION_BYTES = 112, FORCE_BYTES = 88, WAVE_UP_BYTES = 128, WAVE_DOWN_BYTES = 112, STOP = 2, SEAL_BYTES = 16, KEY_BYTES = 32, GREETING = 1, GOODBYE = 1, MOST_ASKED = 32 };

typedef struct {
    int socket;
    uint8_t key[KEY_BYTES];
    uint64_t session, sequence, newest_force;
    uint64_t asked_us[MOST_ASKED];
    int asked;
    /* Wave variables: per finger x and y of the integral, energy. */
    int waves, stopped;
    double impedance, arrived[6], drawn[6], sent[6], purse[2], w[4];
} Hand;

static void hmac_sha256(const uint8_t key[KEY_BYTES], const uint8_t *message, size_t size, uint8_t out[32]);

static uint64_t clock_us(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000u + (uint64_t)now.tv_nsec / 1000u;
}

static void sleep_us(long us)
{
    struct timespec time = {us / 1000000, us % 1000000 * 1000};
    nanosleep(&time, NULL);
}

/* Positions (m) as x1, y1, x2, y2 and velocities (m/s) after them; with waves only the positions where the session began count. */
static void send_motion(Hand *hand, const double motion[8], uint16_t flags)
{
    uint8_t packet[WAVE_UP_BYTES] = {'T', 'S', 'U', 'D', 1, 1};
    uint8_t seal[32];
    uint64_t now = clock_us();
    const size_t size = hand->waves ? WAVE_UP_BYTES : MOTION_BYTES;
    hand->sequence++;
    if (hand->session == 0 && hand->asked < MOST_ASKED) hand->asked_us[hand->asked++] = now;
    memcpy(packet + 6, &flags, 2);
    memcpy(packet + 8, &hand->session, 8);
    memcpy(packet + 16, &hand->sequence, 8);
    memcpy(packet + 24, &now, 8);
    if (hand->waves) {
        packet[4] = 2;
        packet[5] = 3;
        memcpy(packet + 32, motion, 32);
        memcpy(packet + 64, hand->sent, 48);
    } else {
        memcpy(packet + 32, motion, 64);
    }
    hmac_sha256(hand->key, packet, size - SEAL_BYTES, seal);
    memcpy(packet + size - SEAL_BYTES, seal, SEAL_BYTES);
    (void)!send(hand->socket, packet, size, 0);
}

/* A tick of dt seconds begins: the forces (N) to put on the fingers, for their velocities (m/s) of the tick before. */
static void wave_forces(Hand *hand, const double velocity[4], double dt, double force[4])
{
    const double smoothing = 0.02, most_n = hand->stopped ? 0.0 : 4.0, root = sqrt(2.0 * hand->impedance);
    int finger, axis;
    for (finger = 0; finger < 2; finger++) {
        double *arrived = hand->arrived + 3 * finger, *drawn = hand->drawn + 3 * finger, *w = hand->w + 2 * finger;
        double energy = arrived[2] - drawn[2], most = energy > 0.0 ? sqrt(2.0 * energy / dt) : 0.0, size;
        for (axis = 0; axis < 2; axis++) w[axis] = (arrived[axis] - drawn[axis]) / smoothing;
        size = sqrt(w[0] * w[0] + w[1] * w[1]);
        for (axis = 0; axis < 2; axis++) {
            if (size > most) w[axis] *= most / size;
            drawn[axis] += w[axis] * dt;
            force[2 * finger + axis] = root * w[axis] - hand->impedance * velocity[2 * finger + axis];
        }
        drawn[2] += 0.5 * (w[0] * w[0] + w[1] * w[1]) * dt;
        size = sqrt(force[2 * finger] * force[2 * finger] + force[2 * finger + 1] * force[2 * finger + 1]);
        for (axis = 0; axis < 2 && size > most_n; axis++) force[2 * finger + axis] *= most_n / size;
    }
}

/* The tick ends: under these forces (N) the fingers have moved by so much (m). */
static void wave_moved(Hand *hand, const double force[4], const double moved[4], double dt)
{
    const double root = sqrt(2.0 * hand->impedance);
    int finger, axis;
    for (finger = 0; finger < 2; finger++) {
        double *sent = hand->sent + 3 * finger, *w = hand->w + 2 * finger, energy = 0.0, income = 0.0;
        for (axis = 0; axis < 2; axis++) {
            double u = root * moved[2 * finger + axis] / dt - w[axis];
            sent[axis] += u * dt;
            energy += 0.5 * u * u * dt;
            income += 0.5 * w[axis] * w[axis] * dt - force[2 * finger + axis] * moved[2 * finger + axis];
        }
        /* The wave may carry no more than this end took in. */
        hand->purse[finger] += income;
        if (energy > hand->purse[finger]) energy = hand->purse[finger] > 0.0 ? hand->purse[finger] : 0.0;
        sent[2] += energy;
        hand->purse[finger] -= energy;
        if (hand->purse[finger] > 1e-4) hand->purse[finger] = 1e-4;
    }
}

/* Takes all packets that have come; returns 1 when there was a new force (fx1, fy1, fx2, fy2 in N), or new waves. */
static int receive_force(Hand *hand, double force[4])
{
    uint8_t packet[256], seal[32];
    ssize_t size;
    int fresh = 0;
    while ((size = recv(hand->socket, packet, sizeof packet, MSG_DONTWAIT)) >= 0) {
        uint16_t flags;
        uint64_t session, sequence, echo_us;
        uint8_t difference = 0;
        double values[6] = {0};
        const ssize_t whole = hand->waves ? WAVE_DOWN_BYTES : FORCE_BYTES;
        int i;
        if (size != whole || memcmp(packet, hand->waves ? "TSUD\x02\x04" : "TSUD\x01\x02", 6) != 0) continue;
        hmac_sha256(hand->key, packet, (size_t)whole - SEAL_BYTES, seal);
        for (i = 0; i < SEAL_BYTES; i++) difference |= seal[i] ^ packet[whole - SEAL_BYTES + i];
        if (difference) continue;
        memcpy(&flags, packet + 6, 2);
        memcpy(&session, packet + 8, 8);
        memcpy(&sequence, packet + 16, 8);
        memcpy(values, packet + 32, hand->waves ? 48 : 32);
        memcpy(&echo_us, packet + whole - SEAL_BYTES - 8, 8);
        if (flags & GREETING) {
            /* Only the answer to a question of this run: a greeting recorded long ago would lead astray. */
            for (i = 0; hand->session == 0 && i < hand->asked; i++) {
                if (hand->asked_us[i] == echo_us) {
                    hand->session = session;
                    hand->newest_force = sequence;
                    if (hand->waves) memcpy(&hand->impedance, packet + 80, 8);
                }
            }
            continue;
        }
        if (session != hand->session || sequence <= hand->newest_force) continue;
        for (i = 0; i < 6 && isfinite(values[i]); i++) {}
        if (i < 6) continue;
        hand->newest_force = sequence;
        if (hand->waves) {
            memcpy(hand->arrived, values, sizeof values);
            hand->stopped = (flags & STOP) != 0;
        } else {
            memcpy(force, values, 4 * sizeof *force);
        }
        fresh = 1;
    }
    return fresh;
}

static int read_key(const char *path, uint8_t key[KEY_BYTES])
{
    FILE *file = fopen(path, "r");
    int i;
    unsigned byte;
    if (!file) return 0;
    for (i = 0; i < KEY_BYTES && fscanf(file, "%2x", &byte) == 1; i++) key[i] = (uint8_t)byte;
    fclose(file);
    return i == KEY_BYTES;
}

int main(int count, char **arguments)
{
    Hand hand = {0};
    struct sockaddr_in address = {0};
    double motion[8] = {-0.02, -0.11, 0.02, -0.11}, force[4] = {0}, largest = 0.0;
    unsigned long answers = 0;
    double velocity[4] = {0}, moved[4] = {0}, before, last = 0.0;
    uint64_t start;
    double seconds;
    int i;
    hand.waves = count == 6 && strcmp(arguments[5], "waves") == 0;
    if (count != 5 && !hand.waves) {
        fprintf(stderr, "usage: client ADDRESS PORT KEYFILE SECONDS [waves]\n");
        return 2;
    }
    if (!read_key(arguments[3], hand.key)) {
        fprintf(stderr, "%s does not hold a key of 64 hexadecimal digits\n", arguments[3]);
        return 1;
    }
    address.sin_family = AF_INET;
    address.sin_port = htons((uint16_t)atoi(arguments[2]));
    seconds = atof(arguments[4]);
    hand.socket = socket(AF_INET, SOCK_DGRAM, 0);
    if (hand.socket < 0 || inet_pton(AF_INET, arguments[1], &address.sin_addr) != 1 ||
        connect(hand.socket, (struct sockaddr *)&address, sizeof address) != 0) {
        fprintf(stderr, "%s:%s is no address to send to\n", arguments[1], arguments[2]);
        return 1;
    }
    for (i = 0; hand.session == 0 && i < 2500; i++) {
        if (i % 100 == 0) send_motion(&hand, motion, 0);
        sleep_us(2000);
        receive_force(&hand, force);
    }
    if (hand.session == 0) {
        fprintf(stderr, "nobody answers at %s:%s; is Touchstone listening there, with this key?\n", arguments[1], arguments[2]);
        return 1;
    }
    start = clock_us();
    for (;;) {
        double now = (double)(clock_us() - start) * 1e-6;
        double dt = now - last > 1e-5 ? now - last : 1e-5;
        if (now >= seconds) break;
        last = now;
        if (hand.waves) {
            /* The same way, by waves; a stiff hand that does not give way to the force. */
            const double origin[8] = {-0.02, -0.11, 0.02, -0.11};
            if (receive_force(&hand, force)) answers++;
            wave_forces(&hand, velocity, dt, force);
            before = motion[1];
            motion[1] = motion[3] = now < 0.5 ? -0.11 - 0.017 * now / 0.5 : -0.127;
            moved[1] = moved[3] = motion[1] - before;
            for (i = 0; i < 4; i++) velocity[i] = moved[i] / dt;
            wave_moved(&hand, force, moved, dt);
            send_motion(&hand, origin, 0);
            if (force[1] > largest) largest = force[1];
            sleep_us(2000);
            continue;
        }
        /* Down to 2 mm below the table's surface within the first half second, then still. */
        motion[1] = motion[3] = now < 0.5 ? -0.11 - 0.017 * now / 0.5 : -0.127;
        motion[5] = motion[7] = now < 0.5 ? -0.017 / 0.5 : 0.0;
        send_motion(&hand, motion, 0);
        sleep_us(2000);
        if (receive_force(&hand, force)) {
            answers++;
            if (force[1] > largest) largest = force[1];
        }
        /* A real device sets its motors here, and to zero when nothing has come for 50 ms. */
    }
    send_motion(&hand, motion, GOODBYE);
    printf("{\"sent\": %llu, \"answers\": %lu, \"largest_force_N\": %.6f}\n", (unsigned long long)hand.sequence, answers, largest);
    close(hand.socket);
    return 0;
}

/* SHA-256 (FIPS 180-4) and HMAC (RFC 2104). */

static const uint32_t K[64] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5, 0xd807aa98, 0x12835b01, 0x243185be,
    0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174, 0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa,
    0x5cb0a9dc, 0x76f988da, 0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967, 0x27b70a85,
    0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85, 0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3,
    0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070, 0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f,
    0x682e6ff3, 0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

static uint32_t rotate(uint32_t x, int by) { return x >> by | x << (32 - by); }

static void compress(uint32_t state[8], const uint8_t block[64])
{
    uint32_t w[64], s[8];
    int i;
    for (i = 0; i < 16; i++)
        w[i] = (uint32_t)block[4 * i] << 24 | (uint32_t)block[4 * i + 1] << 16 | (uint32_t)block[4 * i + 2] << 8 | block[4 * i + 3];
    for (; i < 64; i++) {
        uint32_t a = rotate(w[i - 15], 7) ^ rotate(w[i - 15], 18) ^ w[i - 15] >> 3;
        uint32_t b = rotate(w[i - 2], 17) ^ rotate(w[i - 2], 19) ^ w[i - 2] >> 10;
        w[i] = w[i - 16] + a + w[i - 7] + b;
    }
    memcpy(s, state, sizeof s);
    for (i = 0; i < 64; i++) {
        uint32_t a = s[7] + (rotate(s[4], 6) ^ rotate(s[4], 11) ^ rotate(s[4], 25)) + ((s[4] & s[5]) ^ (~s[4] & s[6])) + K[i] + w[i];
        uint32_t b = (rotate(s[0], 2) ^ rotate(s[0], 13) ^ rotate(s[0], 22)) + ((s[0] & s[1]) ^ (s[0] & s[2]) ^ (s[1] & s[2]));
        memmove(s + 1, s, 7 * sizeof *s);
        s[4] += a;
        s[0] = a + b;
    }
    for (i = 0; i < 8; i++) state[i] += s[i];
}

/* Over two pieces, of which the first is one whole block. */
static void sha256(const uint8_t first[64], const uint8_t *rest, size_t size, uint8_t out[32])
{
    uint32_t state[8] = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    uint8_t block[64];
    uint64_t bits = 8 * (64 + (uint64_t)size);
    int i;
    compress(state, first);
    for (; size >= 64; size -= 64, rest += 64) compress(state, rest);
    memset(block, 0, sizeof block);
    memcpy(block, rest, size);
    block[size] = 0x80;
    if (size >= 56) {
        compress(state, block);
        memset(block, 0, sizeof block);
    }
    for (i = 0; i < 8; i++) block[56 + i] = (uint8_t)(bits >> (56 - 8 * i));
    compress(state, block);
    for (i = 0; i < 32; i++) out[i] = (uint8_t)(state[i / 4] >> (24 - i % 4 * 8));
}

static void hmac_sha256(const uint8_t key[KEY_BYTES], const uint8_t *message, size_t size, uint8_t out[32])
{
    uint8_t pad[64];
    uint8_t inner[32];
    int i;
    for (i = 0; i < 64; i++) pad[i] = 0x36 ^ (i < KEY_BYTES ? key[i] : 0);
    sha256(pad, message, size, inner);
    for (i = 0; i < 64; i++) pad[i] ^= 0x36 ^ 0x5c;
    sha256(pad, inner, sizeof inner, out);
}
