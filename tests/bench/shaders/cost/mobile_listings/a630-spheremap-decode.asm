Native code for unnamed FRAG shader (null) with sha1 43e03c9fd895de2a931b791a1f0dcf6faa60e25f:
; num_ubos:           0
; num_driver_params:  0
; offsets:
; ubo_state:
;   num_enabled:      0
@in(r0.x)	in0 (wrmask=0x3)
@const(c0.x)	0x3f800000, 0x3e800000, 0x3f000000, 0xd0d0d0d0
bary.f r0.w, 1, r0.x
bary.f r0.z, 0, r0.x
bary.f r2.x, 2, r0.x
bary.f r2.y, 3, r0.x
bary.f (ei)r2.z, 4, r0.x
mul.f r1.x, r0.w, (2.0)
(nop2) mul.f r1.y, r0.z, (2.0)
(nop1) mul.f r1.z, r1.x, r1.x
(nop3) mad.f32 r1.z, r1.y, r1.y, r1.z
(nop3) min.f r1.z, r1.z, (4.0)
mad.f32 r1.w, c0.y, (neg)r1.z, c0.x
(nop3) mad.f32 r3.y, c0.z, (neg)r1.z, c0.x
(rpt1)nop
sqrt r1.w, r1.w
(ss)mul.f r2.w, r1.y, r1.w
mul.f r3.x, r1.x, r1.w
end
nop
nop
nop
nop
nop
nop
nop
nop
nop
nop
nop
nop
nop
nop
nop
; FRAG: outputs: r2.w (FRAG_RESULT_DATA0) r0.z (FRAG_RESULT_DATA1) r2.x (FRAG_RESULT_DATA2)
; FRAG: inputs: r63.x (VARYING_SLOT_VAR0 slot=32 cm=3,il=0,b=1) r63.x (VARYING_SLOT_VAR1 slot=33 cm=7,il=2,b=1) r0.x (SYSTEM_VALUE_BARYCENTRIC_PERSP_PIXEL slot=52 cm=3,il=5,b=0)
; FRAG prog 32/1: 30 instr, 14 nops, 16 non-nops, 0 mov, 0 cov, 64 dwords
; FRAG prog 32/1: 4 last-baryf, 0 half, 4 full, 4 constlen
; FRAG prog 32/1: 15 cat0, 0 cat1, 11 cat2, 3 cat3, 1 cat4, 0 cat5, 0 cat6, 0 cat7, 
; FRAG prog 32/1: 10 sstall, 1 (ss), 0 systall, 0 (sy), 0 loops
; pos (ij_pixel): r0.x
; data0: r2.w
; data1: r0.z
; data2: r2.x

