Push constant ranges:
    RANGE0 (32B): Vulkan push constants and API params

mov(8)          g2<1>UW         0x76543210V                     { align1 WE_all 1Q };
shl(16)         g3<1>D          g1.1<0,1,0>D    0x00000004UD    { align1 1H };
add(8)          g2.8<1>UW       g2<8,8,1>UW     0x0008UW        { align1 WE_all 1Q };
mov(16)         g5<1>D          g2<8,8,1>UW                     { align1 1H };
add(16)         g7<1>D          g5<8,8,1>D      g3<8,8,1>D      { align1 1H compacted };
and(16)         g9<1>UD         g7<8,8,1>UD     0x0000003fUD    { align1 1H compacted };
shl(16)         g39<1>D         g9<8,8,1>D      0x00000002UD    { align1 1H };
send(16)        g56<1>UW        g39<0,1,0>UD    0x04205e02
                            dp data 1 MsgDesc: (untyped surface read, Surface = 2, SIMD16, Mask = 0xe) mlen 2 rlen 2 { align1 1H };
add(16)         g43<1>D         g39<8,8,1>D     256D            { align1 1H compacted };
add(16)         g50<1>D         g39<8,8,1>D     1024D           { align1 1H compacted };
add(16)         g52<1>D         g39<8,8,1>D     1280D           { align1 1H compacted };
add(16)         g37<1>D         g39<8,8,1>D     1536D           { align1 1H compacted };
send(16)        g59<1>UW        g43<0,1,0>UD    0x04205e02
                            dp data 1 MsgDesc: (untyped surface read, Surface = 2, SIMD16, Mask = 0xe) mlen 2 rlen 2 { align1 1H };
send(16)        g41<1>UW        g50<0,1,0>UD    0x04205e02
                            dp data 1 MsgDesc: (untyped surface read, Surface = 2, SIMD16, Mask = 0xe) mlen 2 rlen 2 { align1 1H };
send(16)        g45<1>UW        g52<0,1,0>UD    0x04205e02
                            dp data 1 MsgDesc: (untyped surface read, Surface = 2, SIMD16, Mask = 0xe) mlen 2 rlen 2 { align1 1H };
send(16)        g48<1>UW        g37<0,1,0>UD    0x04205e02
                            dp data 1 MsgDesc: (untyped surface read, Surface = 2, SIMD16, Mask = 0xe) mlen 2 rlen 2 { align1 1H };
xor(16)         g14<1>UD        g56<8,8,1>UD    g59<8,8,1>UD    { align1 1H compacted };
xor(16)         g17<1>UD        g14<8,8,1>UD    g41<8,8,1>UD    { align1 1H compacted };
xor(16)         g20<1>UD        g17<8,8,1>UD    g45<8,8,1>UD    { align1 1H compacted };
xor.nz.f0.0(16) null<1>UD       g20<8,8,1>UD    g48<8,8,1>UD    { align1 1H compacted };
(+f0.0) if(16)  JIP:  LABEL0          UIP:  LABEL0              { align1 1H };
mul(16)         g23<1>F         -g59<8,8,1>F    g59<8,8,1>F     { align1 1H compacted };
mad(16)         g25<1>F         g23<4,4,1>F     g56<4,4,1>F     -g56<4,4,1>F { align16 1H compacted };
add.sat(16)     g27<1>F         g25<8,8,1>F     0x3f800000F  /* 1F */ { align1 1H };
math sqrt(16)   g62<1>F         g27<8,8,1>F     null<8,8,1>F    { align1 1H compacted };
sends(16)       nullUD          g39UD           g41UD           0x04025e02                0x00000080
                            dp data 1 MsgDesc: (DC untyped surface write, Surface = 2, SIMD16, Mask = 0xe) mlen 2 ex_mlen 2 rlen 0 { align1 1H };
sends(16)       nullUD          g43UD           g45UD           0x04025e02                0x00000080
                            dp data 1 MsgDesc: (DC untyped surface write, Surface = 2, SIMD16, Mask = 0xe) mlen 2 ex_mlen 2 rlen 0 { align1 1H };
add(16)         g46<1>D         g39<8,8,1>D     512D            { align1 1H compacted };
sends(16)       nullUD          g46UD           g48UD           0x04025e02                0x00000080
                            dp data 1 MsgDesc: (DC untyped surface write, Surface = 2, SIMD16, Mask = 0xe) mlen 2 ex_mlen 2 rlen 0 { align1 1H };
sends(16)       nullUD          g50UD           g56UD           0x04025e02                0x00000080
                            dp data 1 MsgDesc: (DC untyped surface write, Surface = 2, SIMD16, Mask = 0xe) mlen 2 ex_mlen 2 rlen 0 { align1 1H };
sends(16)       nullUD          g52UD           g59UD           0x04025e02                0x00000080
                            dp data 1 MsgDesc: (DC untyped surface write, Surface = 2, SIMD16, Mask = 0xe) mlen 2 ex_mlen 2 rlen 0 { align1 1H };
add(16)         g54<1>D         g39<8,8,1>D     2048D           { align1 1H compacted };
sends(16)       nullUD          g54UD           g56UD           0x04025e02                0x00000080
                            dp data 1 MsgDesc: (DC untyped surface write, Surface = 2, SIMD16, Mask = 0xe) mlen 2 ex_mlen 2 rlen 0 { align1 1H };
add(16)         g57<1>D         g39<8,8,1>D     2304D           { align1 1H compacted };
sends(16)       nullUD          g57UD           g59UD           0x04025e02                0x00000080
                            dp data 1 MsgDesc: (DC untyped surface write, Surface = 2, SIMD16, Mask = 0xe) mlen 2 ex_mlen 2 rlen 0 { align1 1H };
add(16)         g60<1>D         g39<8,8,1>D     2560D           { align1 1H compacted };
sends(16)       nullUD          g60UD           g62UD           0x04025e02                0x00000080
                            dp data 1 MsgDesc: (DC untyped surface write, Surface = 2, SIMD16, Mask = 0xe) mlen 2 ex_mlen 2 rlen 0 { align1 1H };

LABEL0:
endif(16)       JIP:  LABEL1                                    { align1 1H };

LABEL1:
mov(8)          g126<1>UD       g0<8,8,1>UD                     { align1 WE_all 1Q compacted };
send(16)        null<1>UW       g126<8,8,1>UW   0x82000010
                            thread_spawner MsgDesc: mlen 1 rlen 0           { align1 WE_all 1H EOT };
