#pragma once

#include <array>
#include <cstdint>

// Printed by scripts/derive_fixed_tables.py.

namespace samestep::raw {

/// 2^96 / (2 pi), upper part: turns per raw unit of an angle.
inline constexpr std::uint64_t kTurnsHigh = 0x28be60db;

/// Its lower part.
inline constexpr std::uint64_t kTurnsLow = 0x9391054a7f09d5f4;

/// Sine on [0, pi / 4], error 3.4e-15: powers 0 to 2 of z with 63, 64, 65 fraction bits, without their signs
/// + - +.
inline constexpr std::array<std::uint64_t, 3> kSineTerms = {0x6487ed5110b3e7f0, 0x14abbce6257a2a26,
                                                            0x1466bc67123fa17};

/// Powers 3 to 5, Q42.
inline constexpr std::array<std::int64_t, 3> kSineHighTerms = {-0x9969632, 0x15071d, -0x1dd5};

/// Cosine on [0, pi / 4], error 5.6e-14: powers 0 to 2 of z with 63, 64, 65 fraction bits, without their
/// signs + - +.
inline constexpr std::array<std::uint64_t, 3> kCosineTerms = {0x7ffffffffff82d2b, 0x4ef4f326f4b0d412,
                                                              0x81e0f83a6f69041};

/// Powers 3 to 5, Q42.
inline constexpr std::array<std::int64_t, 3> kCosineHighTerms = {-0x5574ee8c, 0xf0f3e6, -0x1a0ee};

/// (1 - atan(t) / t) / z; powers 0 to 4 of z, Q32; error 7.8e-11.
inline constexpr std::array<std::int64_t, 5> kArcTerms = {0x55555555, -0x3333320b, 0x2491a537, -0x1c51cb92,
                                                          0x14b0aaa2};

/// atan(0), atan(1/2), atan(1), Q62; the same from pi / 2 back, from pi back, and from pi / 2 on.
inline constexpr std::array<std::uint64_t, 12> kArcBase = {0x0,
                                                           0x1dac670561bb4f69,
                                                           0x3243f6a8885a308d,
                                                           0x6487ed5110b4611a,
                                                           0x46db864baef911b2,
                                                           0x3243f6a8885a308d,
                                                           0xc90fdaa22168c235,
                                                           0xab63739cbfad72cc,
                                                           0x96cbe3f9990e91a8,
                                                           0x6487ed5110b4611a,
                                                           0x82345456726fb083,
                                                           0x96cbe3f9990e91a8};

/// (2^d - 1) / d for d below 1/64; powers 0 to 5 with 64, 64, 64, 64, 41, 41 fraction bits; error 1.1e-19.
inline constexpr std::array<std::uint64_t, 6> kPowerTerms = {
    0xb17217f7d1cf79aa, 0x3d7f7bff058b4173, 0xe35846b81e70032, 0x276556e67a9f841, 0xaec392ea, 0x14489e5e};

/// 2^(i / 64) in units of 2^-63.
inline constexpr std::array<std::uint64_t, 64> kPowerHigh = {
    0x8000000000000000, 0x8164d1f3bc030773, 0x82cd8698ac2ba1d7, 0x843a28c3acde4046, 0x85aac367cc487b14,
    0x871f61969e8d1010, 0x88980e8092da8527, 0x8a14d575496efd9a, 0x8b95c1e3ea8bd6e6, 0x8d1adf5b7e5ba9e5,
    0x8ea4398b45cd53c0, 0x9031dc431466b1dc, 0x91c3d373ab11c336, 0x935a2b2f13e6e92b, 0x94f4efa8fef70961,
    0x96942d3720185a00, 0x9837f0518db8a96f, 0x99e0459320b7fa64, 0x9b8d39b9d54e5538, 0x9d3ed9a72cffb750,
    0x9ef5326091a111ad, 0xa0b0510fb9714fc2, 0xa27043030c496818, 0xa43515ae09e6809e, 0xa5fed6a9b15138ea,
    0xa7cd93b4e9653569, 0xa9a15ab4ea7c0ef8, 0xab7a39b5a93ed337, 0xad583eea42a14ac6, 0xaf3b78ad690a4374,
    0xb123f581d2ac258f, 0xb311c412a9112489, 0xb504f333f9de6484, 0xb6fd91e328d17791, 0xb8fbaf4762fb9ee9,
    0xbaff5ab2133e45fb, 0xbd08a39f580c36be, 0xbf1799b67a731082, 0xc12c4cca66709456, 0xc346ccda24976407,
    0xc5672a115506dadd, 0xc78d74c8abb9b15c, 0xc9b9bd866e2f27a2, 0xcbec14fef2727c5c, 0xce248c151f8480e3,
    0xd06333daef2b2594, 0xd2a81d91f12ae45a, 0xd4f35aabcfedfa1f, 0xd744fccad69d6af4, 0xd99d15c278afd7b5,
    0xdbfbb797daf23755, 0xde60f4825e0e9123, 0xe0ccdeec2a94e111, 0xe33f8972be8a5a51, 0xe5b906e77c8348a8,
    0xe8396a503c4bdc68, 0xeac0c6e7dd24392e, 0xed4f301ed9942b84, 0xefe4b99bdcdaf5cb, 0xf281773c59ffb139,
    0xf5257d152486cc2c, 0xf7d0df730ad13bb8, 0xfa83b2db722a033a, 0xfd3e0c0cf486c174};

/// Its next 64 bits.
inline constexpr std::array<std::uint64_t, 64> kPowerLow = {0x0,
                                                            0x7be56527bd14def5,
                                                            0x3e2a475b46520bff,
                                                            0x1af92eca13fd1582,
                                                            0xc5c95b8c2154c1b2,
                                                            0x3a1727c57b52a956,
                                                            0x5df8d76c98c67563,
                                                            0x80ca1d92c3680c2,
                                                            0xfbe4628758a53c90,
                                                            0xb4c7b4968e41ad36,
                                                            0x2dc0144c8783d4c6,
                                                            0x775814a8494e87e2,
                                                            0xfd6d8e0ae5ac9d8,
                                                            0xd339940e9d924ee7,
                                                            0x2e8afad12551de54,
                                                            0x48ea9b683a9c22c5,
                                                            0x46ad23182e42f6f6,
                                                            0xe43086cb34b5fcaf,
                                                            0xa2a817a2a3cc3f1f,
                                                            0xde494cf050e99b0b,
                                                            0xa0911f09ebb9fdd1,
                                                            0x192dc79edb0fd9a9,
                                                            0x9b7a04ef80cfdea8,
                                                            0xd1db4831781e1ef,
                                                            0x1cbd7f621710701b,
                                                            0x9ec5b4d5039f72af,
                                                            0x541e24ec3531fa73,
                                                            0x658023b2759e0079,
                                                            0x4980a8c8f59a2ec4,
                                                            0xdf26101ccbb35033,
                                                            0x87d037e96d215d8e,
                                                            0x3ecf14dc798a519c,
                                                            0x597d89b3754abe9f,
                                                            0x7165f0ddd541a5a,
                                                            0x1b879778566b65a2,
                                                            0x74d519d24593838c,
                                                            0xa8811fb66d0faf7a,
                                                            0xe815d0abcbf0b851,
                                                            0x7c457d59a50087b5,
                                                            0x20ec856128b83a42,
                                                            0x3e2ad0c964dd9f37,
                                                            0xc13a2e3976c0277e,
                                                            0x80e1f92a0511697e,
                                                            0xf4907c8f45ebf6dd,
                                                            0xe235838f95f2c6ed,
                                                            0xd6d45c6559a4d502,
                                                            0x12248e57c3de4028,
                                                            0x5921deffa6262c5b,
                                                            0x39a68bb9902d3fde,
                                                            0xfe873deca3e12bac,
                                                            0x3d840d5a9e29aa64,
                                                            0xdd07a2d9e8466859,
                                                            0x65895048dd333ca,
                                                            0x9bfe90795980eed,
                                                            0x1e5e8f4a4edbb0ed,
                                                            0x791790d0ac70c7de,
                                                            0xd02d75b3706e54fb,
                                                            0x600d2db6a64bfb12,
                                                            0x46561cf6948db913,
                                                            0xe8980a9cc8f47a4b,
                                                            0x7b9d0c7aed980fc3,
                                                            0xfe90d496d60fb6eb,
                                                            0x7c25bb14315d7fcd,
                                                            0x853f3a5931e0ee03};

/// log2(e) in units of 2^-63.
inline constexpr std::uint64_t kLog2eHigh = 0xb8aa3b295c17f0bb;

/// Its next 64 bits.
inline constexpr std::uint64_t kLog2eLow = 0xbe87fed0691d3e89;

/// About 512 / m in each 64th of [1, 2); exact at both ends.
inline constexpr std::array<std::uint64_t, 64> kInverse = {
    0x200, 0x1f4, 0x1ed, 0x1e5, 0x1de, 0x1d7, 0x1d1, 0x1ca, 0x1c4, 0x1be, 0x1b8, 0x1b2, 0x1ac,
    0x1a7, 0x1a1, 0x19c, 0x197, 0x192, 0x18d, 0x188, 0x184, 0x17f, 0x17b, 0x176, 0x172, 0x16e,
    0x16a, 0x166, 0x162, 0x15e, 0x15b, 0x157, 0x154, 0x150, 0x14d, 0x149, 0x146, 0x143, 0x140,
    0x13d, 0x13a, 0x137, 0x134, 0x131, 0x12e, 0x12b, 0x129, 0x126, 0x123, 0x121, 0x11e, 0x11c,
    0x119, 0x117, 0x115, 0x112, 0x110, 0x10e, 0x10b, 0x109, 0x107, 0x105, 0x103, 0x100};

/// -log2(kInverse[i] / 512) in units of 2^-56.
inline constexpr std::array<std::uint64_t, 64> kInverseLogHigh = {0x0,
                                                                  0x8c25c7262b57c,
                                                                  0xdf7648a8d5617,
                                                                  0x14023b7b26ac9d,
                                                                  0x1960caf9abb7c9,
                                                                  0x1ed3a1d4cdbeba,
                                                                  0x238fcefbbc67b7,
                                                                  0x2929f0c771be69,
                                                                  0x2e08c0638f3f09,
                                                                  0x32f8396278fd81,
                                                                  0x37f8cf4fffe998,
                                                                  0x3d0afa7a6c26cf,
                                                                  0x422f383657e8df,
                                                                  0x4686429759d281,
                                                                  0x4bccf9b48483c6,
                                                                  0x5041805f0fb28a,
                                                                  0x54c3f423ca7e9c,
                                                                  0x5954ad266189dd,
                                                                  0x5df406d9bef4da,
                                                                  0x62a2602afef4c9,
                                                                  0x666c1caa5b1ac9,
                                                                  0x6b36704c3754fd,
                                                                  0x6f17152249532e,
                                                                  0x73feb9846b44ad,
                                                                  0x77f7627561b8ac,
                                                                  0x7bfb186c047e15,
                                                                  0x800a1995f00195,
                                                                  0x8424a6335c777e,
                                                                  0x884b00aef726ce,
                                                                  0x8c7d6db7169e0c,
                                                                  0x8fab564f6cd468,
                                                                  0x93f390407e6f2e,
                                                                  0x973227d6027ebd,
                                                                  0x9b9115db83a3dd,
                                                                  0x9ee10f309e79c8,
                                                                  0xa357a720d0f9f5,
                                                                  0xa6b9c06e621164,
                                                                  0xaa23db93321cd5,
                                                                  0xad961ed0cb91d4,
                                                                  0xb110b17d788c15,
                                                                  0xb493bc0ec99542,
                                                                  0xb81f68249dc7b3,
                                                                  0xbbb3e094b3d228,
                                                                  0xbf515176cbe671,
                                                                  0xc2f7e831632b66,
                                                                  0xc6a7d38711e46e,
                                                                  0xc92261d140d42d,
                                                                  0xcce245f1031e41,
                                                                  0xd0ac02705f4442,
                                                                  0xd338120a6dd9d3,
                                                                  0xd712ac0cf81165,
                                                                  0xd9aa2c3b0ea3cb,
                                                                  0xdd963c96edf3a4,
                                                                  0xe03995f0f4ff5b,
                                                                  0xe2e1cb1ca47d25,
                                                                  0xe6e75e91b9cca5,
                                                                  0xe99c090536ece9,
                                                                  0xec55d022d80e3d,
                                                                  0xf0763b3e66d630,
                                                                  0xf33d201e5b5735,
                                                                  0xf60967b5cbd2ec,
                                                                  0xf8db27115ebc1e,
                                                                  0xfbb273ba15a13c,
                                                                  0x100000000000000};

/// Its next 64 bits.
inline constexpr std::array<std::uint64_t, 64> kInverseLogLow = {0x0,
                                                                 0x1491f06c085bc1b8,
                                                                 0x28d82263ecf5713e,
                                                                 0xc37ebff430b83f8a,
                                                                 0xede45b7759da88a3,
                                                                 0xa4120bf7c43c80e0,
                                                                 0x162e26d277c6edd1,
                                                                 0x754e94f284604057,
                                                                 0x7c33972aef4b5d4f,
                                                                 0xb5465aa16819f1a,
                                                                 0xde057bdc173ebbc,
                                                                 0x7bc818bcdaf05343,
                                                                 0xb0aa4406f31c097f,
                                                                 0xa3174c8d0586b1a3,
                                                                 0x43a23f1419cf824d,
                                                                 0x39a729fd1994fb2c,
                                                                 0x2742ca023e7a3ec0,
                                                                 0xac9080333c6052e2,
                                                                 0x927291ab2bd74ac3,
                                                                 0x99aa6df8b7d834af,
                                                                 0xbca36fd02deefef7,
                                                                 0x7061311743a67f47,
                                                                 0x75785e97aaf022e3,
                                                                 0x8a38b4175d6653ce,
                                                                 0x2719128c8298d429,
                                                                 0x6d261f1753e0ae1f,
                                                                 0x18ce032f41d1e775,
                                                                 0xb87f95f1befb6f8,
                                                                 0xc5139a7ba83bf2d1,
                                                                 0xda8bd744617e9b7d,
                                                                 0xff68d6d2d35ee628,
                                                                 0x667fa4f513c44f07,
                                                                 0x8a0efca1a184e938,
                                                                 0x2d352bea51e58eaa,
                                                                 0xe0fdac446bc27c3b,
                                                                 0xaf2c99ad757fe357,
                                                                 0x6b761c48dd859de3,
                                                                 0x3be1f94c4fb1ca39,
                                                                 0x6db502402c94093,
                                                                 0xa9f3c8bc9672d8b0,
                                                                 0x43b21709ce430c8e,
                                                                 0x505e5cb020c8b3c0,
                                                                 0xd3da3e961a96c581,
                                                                 0x13a17a4d60b07a5f,
                                                                 0x706c1855c42078f8,
                                                                 0xd2766b4e9dc38da4,
                                                                 0x2824e663a0970820,
                                                                 0xfa0a62e6add1a902,
                                                                 0x1d0364be23e87349,
                                                                 0x66758fb3d77514a,
                                                                 0x9d8e2d7d378127d8,
                                                                 0xc15c1a7f14b168b3,
                                                                 0x194b7dfe0d99a50,
                                                                 0x6fb2cb9c6af72190,
                                                                 0xb2f4c70cdc341a75,
                                                                 0x518dcdb6b24c5c5d,
                                                                 0x8333ac7d9ebba8a5,
                                                                 0x27fb2eede4b59d89,
                                                                 0x2f197ca224352785,
                                                                 0xcfaf8e257842f7a9,
                                                                 0xefec5a47e03b6b85,
                                                                 0x66645fc23a2cb13d,
                                                                 0xed12f964dbbbadee,
                                                                 0x0};

/// 1 / ((k + 2) ln 2), k = 0 to 10, in units of 2^-64: log2(1 + u) = u / ln 2 - u^2 (q0 - u (q1 - ...)).
inline constexpr std::array<std::uint64_t, 11> kLogTerms = {
    0xb8aa3b295c17f0bc, 0x7b1c2770e80ff5d2, 0x5c551d94ae0bf85e, 0x49ddb143be6ff9e5,
    0x3d8e13b87407fae9, 0x34c2ec54f5bdb27f, 0x2e2a8eca5705fc2f, 0x2909627af80551f1,
    0x24eed8a1df37fcf2, 0x2193509328045a51, 0x1ec709dc3a03fd75};

/// Series cut to 5 terms, for log2 alone, in units of 2^-32; error 1.2e-11.
inline constexpr std::array<std::uint64_t, 5> kShortLogTerms = {0xb8aa3b29, 0x7b1c2760, 0x5c551d86,
                                                                0x49e1d0b2, 0x3d91af3a};

}  // namespace samestep::raw
