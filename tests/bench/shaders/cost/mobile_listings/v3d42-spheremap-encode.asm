nop                           ; mov rf10, 0x3f800000        ; ldvary.r0
nop                           ; fmul r1, r0, rf0            ; ldvary.r2
fadd rf3, r1, r5              ; fmul r3, r2, rf0            ; ldvary.r4
fadd rf4, r3, r5              ; fmul r0, r4, rf0            ; ldvary.r1
fadd rf5, r0, r5              ; fmul r2, r1, rf0            ; ldvary.r3
fadd rf6, r2, r5              ; fmul r4, r3, rf0            ; ldvary.r0
fadd rf7, r4, r5              ; fmul r2, 0x41000000, rf5
fadd r3, r2, 0x41000000       ; fmul r1, r0, rf0
rsqrt rf9, r3                 ; mov rf11, 0
fadd rf8, r1, r5              ; nop                         ; ldunif
nop                           ; fmul r4, 0x40000000, rf9
fcmp.pushn -, r5, rf5         ; fmul r0, rf3, r4
nop                           ; fmul r1, rf4, r4            ; thrsw
nop                           ; mov.ifa rf10, r0            ; thrsw
nop                           ; mov.ifa rf11, r1
nop                           ; mov tlbu, rf10
nop                           ; mov tlb, rf11
nop                           ; mov tlbu, rf3
nop                           ; mov tlb, rf4
nop                           ; mov tlb, rf5
nop                           ; mov tlbu, rf6               ; thrsw
nop                           ; mov tlb, rf7
nop                           ; mov tlb, rf8
