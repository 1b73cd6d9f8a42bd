nop                           ; nop                         ; ldvary.r0
nop                           ; fmul r1, r0, rf0            ; ldvary.r2
fadd rf3, r1, r5              ; fmul r3, r2, rf0            ; ldvary.r4
fadd rf4, r3, r5              ; fmul r0, r4, rf0            ; ldvary.r1
fadd rf5, r0, r5              ; fmul r2, r1, rf0            ; ldvary.r3
fadd rf6, r2, r5              ; fmul r0, rf3, 0x40000000
nop                           ; fmul r1, rf4, 0x40000000
nop                           ; fmul r4, r3, rf0
fadd rf7, r4, r5              ; fmul r2, r0, r0
nop                           ; fmul r3, r1, r1
fadd r4, r2, r3               ; nop
fmin r2, r4, 0x40800000       ; nop
nop                           ; fmul r3, r2, 0x3e800000
fsub r4, 0x3f800000, r3       ; nop
rsqrt rf8, r4                 ; fmul r2, r2, 0x3f000000
fsub rf10, 0x3f800000, r2     ; nop
recip rf9, rf8                ; nop                         ; thrsw
nop                           ; fmul rf11, r0, rf9          ; thrsw
nop                           ; fmul rf12, r1, rf9
nop                           ; mov tlbu, rf11
nop                           ; mov tlb, rf12
nop                           ; mov tlb, rf10
nop                           ; mov tlbu, rf3
nop                           ; mov tlb, rf4
nop                           ; mov tlbu, rf5               ; thrsw
nop                           ; mov tlb, rf6
nop                           ; mov tlb, rf7
